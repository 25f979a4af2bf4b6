#pragma once
/// What the examples of plugins/ take for granted.

#include <documentation/example_context.h>
#include <documentation/example_robots.h>
#include <documentation/example_world.h>
#include <locograph/core/graph_file.h>
#include <locograph/plugins/configuration/execution_margin.h>
#include <locograph/plugins/configuration/frame_parameter.h>
#include <locograph/plugins/configuration/stance_parameter.h>
#include <locograph/plugins/configuration/vertex_configuration.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/plugins/surface_distance/place_rows.h>
#include <locograph/plugins/time_step/vertex_time_step.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits_timed.h>
#include <locograph/types/standard_types.h>

namespace locograph::documentation::in_plugins {

inline std::shared_ptr<const RobotParameter> parameter_of(const std::string& name) {
  const RobotFiles files = shipped_robot(name).value();
  return std::make_shared<const RobotParameter>(files.urdf, files.srdf, RobotOptions());
}
inline const std::shared_ptr<const RobotParameter>& centauro_parameter() {
  static const std::shared_ptr<const RobotParameter> parameter = parameter_of("centauro");
  return parameter;
}

/// A plan of three configurations of CENTAURO, which drives forward without turning its wheels.
struct Context {
  const std::shared_ptr<const RobotParameter>& parameter = centauro_parameter();
  const Robot& robot = *parameter->robot;
  Graph graph;
  const ConfigurationState a = state(0), b = state(1), c = state(2), &q = a;
  const VertexId<VertexConfiguration> before = add(0), here = add(1), after = add(2),
                                      configuration = here, from = before, to = after;
  const Eigen::Isometry3d link_from_sole{Eigen::Translation3d(0.0, 0.0, -0.1)},
      world_from_target{Eigen::Translation3d(0.3, 0.3, 0.1)}, world_from_frame = world_from_target;
  const Eigen::Vector3d point = {0.3, 0.3, 0.0}, normal = {0.0, 0.0, 1.0},
                        forward = {1.0, 0.0, 0.0};
  const Eigen::VectorXd limits = Eigen::VectorXd::Constant(robot.active_joint_count() + 2, 5.0);
  Eigen::VectorXd e = limits;
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(limits.size(), robot.tangent_size());
  const double dt_s = 0.1, dt_1_s = 0.1, dt_2_s = 0.1, step_s = 0.2, max_s = 0.1;
  const int i = 0, row = 0;

  Context() { graph.parameters().set(0, parameter); }

  Eigen::VectorXd numbers(int index) const {
    Eigen::VectorXd q = robot.named_configuration("home");
    q[0] += 0.1 * index;
    return q;
  }
  ConfigurationState state(int index) const {
    ConfigurationState state(parameter);
    state.time_s = 0.1 * index;
    state.update(numbers(index).data());
    return state;
  }
  VertexId<VertexConfiguration> add(int index) {
    return graph.add_vertex(index, VertexConfiguration(0, parameter, 0.1 * index, numbers(index)));
  }
  static Contact wheel(int number) {
    const std::string name = "wheel_" + std::to_string(number);
    return {.effector = {.name = name,
                         .link = name,
                         .kind = ContactKind::kWheel,
                         .radius_m = 0.078,
                         .friction = 0.5,
                         .max_force_N = 1000.0}};
  }
  /// PARAMS_CONTACTs of the first wheels.
  void add_wheels(const std::vector<int>& numbers) {
    int number = 0;
    for (const int contact : numbers) {
      graph.parameters().set(
          contact, std::make_shared<const ContactParameter>(parameter, 0, wheel(++number)));
    }
  }
};

/// On four wheels, PARAMS_STANCE 20.
struct RollingContext : Context {
  const std::shared_ptr<const StanceParameter> stance = standing();
  std::shared_ptr<const StanceParameter> standing() {
    const std::vector<int> contacts = {10, 11, 12, 13};
    add_wheels(contacts);
    graph.parameters().set(20,
                           std::make_shared<const StanceParameter>(graph.parameters(), contacts));
    return graph.parameters().get<StanceParameter>(20);
  }
};

/// The same in a room with a step, a rail and a block.
struct PlacesContext : RollingContext {
  const std::shared_ptr<const TouchablePlaces> places =
      std::make_shared<const TouchablePlaces>(parameter, small_room());
  const Eigen::AlignedBox3d around_the_robot{Eigen::Vector3d(-1.0, -1.0, -1.0),
                                             Eigen::Vector3d(1.0, 1.0, 2.0)};
  const std::size_t bound = 0;
  const Eigen::Vector3d centre = {0.0, 0.0, 0.8};
  const double radius = 0.1;
  double least_m = 1.0;
};

namespace configuration_edge_fit_h {
struct Context : in_plugins::Context {
  static constexpr std::string_view kTag = "EDGE_JOINT_LIMITS";
  const Parameters& parameters = graph.parameters();
  const long dimension = robot.active_joint_count();
  const Eigen::VectorXd e = Eigen::VectorXd::Zero(dimension);
};
}  // namespace configuration_edge_fit_h
namespace configuration_frame_parameter_h {
struct Context : in_plugins::Context {
  const Robot& model = robot;
};
}  // namespace configuration_frame_parameter_h
namespace configuration_near_spheres_h {
struct Context : in_plugins::Context {
  const WorldDistance world;
  const double margin_m = 0.05;
  Eigen::VectorXd e = Eigen::VectorXd::Zero(q.sphere_centres.rows());
};
}  // namespace configuration_near_spheres_h
namespace configuration_path_field_h {
struct Context {
  const FileLine where{"plan.g2o", 12, "maps"};
  std::filesystem::path map;
  FieldReader in{"hall.bt", where};
  FieldWriter out{"maps"};
};
}  // namespace configuration_path_field_h
namespace configuration_self_collision_shapes_h {
struct Context {
  const std::shared_ptr<const RobotParameter>& robot = centauro_parameter();
  std::vector<int> first_capsules;
};
}  // namespace configuration_self_collision_shapes_h
namespace configuration_stance_parameter_h {
struct Context : in_plugins::Context {
  Context() { add_wheels({10, 11}); }
};
}  // namespace configuration_stance_parameter_h
namespace contact_edge_contact_h {
struct Context : in_plugins::Context {
  const std::shared_ptr<const RobotParameter>& robot = parameter;
  const Contact standing = wheel(1);
  const VertexId<VertexConfiguration> q = here;
};
}  // namespace contact_edge_contact_h
namespace frame_pose_edge_frame_pose_h {
struct Context : in_plugins::Context {
  const Eigen::Matrix<double, 6, 1> weights = Eigen::Matrix<double, 6, 1>::Ones();
  Context() {
    graph.parameters().set(3, std::make_shared<const FrameParameter>(robot, 0, "ankle2_1"));
  }
};
}  // namespace frame_pose_edge_frame_pose_h
namespace ground_distance_edge_ground_distance_h {
struct Context : in_plugins::Context {
  const std::shared_ptr<const RobotParameter>& robot = parameter;
};
}  // namespace ground_distance_edge_ground_distance_h
namespace ground_distance_edge_link_height_h {
/// Of COMAN+, whose soles are called so.
struct Context {
  static constexpr int kRobotNumber = 0;
  const std::shared_ptr<const RobotParameter> parameter = parameter_of("coman_plus");
  const Robot& model = *parameter->robot;
  Graph graph;
  const VertexId<VertexConfiguration> configuration = add();
  VertexId<VertexConfiguration> add() {
    graph.parameters().set(kRobotNumber, parameter);
    return graph.add_vertex(
        0, VertexConfiguration(kRobotNumber, parameter, 0.0, model.named_configuration("home")));
  }
};
}  // namespace ground_distance_edge_link_height_h
namespace robot_types_h {
/// With the file of a plan.
struct Context : RollingContext {
  Context() { write_graph(graph, "plan.g2o"); }
};
}  // namespace robot_types_h
namespace rolling_edge_ball_rolling_h {
/// 11: a ball.
struct Context : in_plugins::Context {
  Context() {
    const Contact ball = {.effector = {.name = "hand",
                                       .link = "ball1_tip",
                                       .kind = ContactKind::kPoint,
                                       .radius_m = 0.05,
                                       .friction = 0.5,
                                       .max_force_N = 300.0}};
    graph.parameters().set(11, std::make_shared<const ContactParameter>(parameter, 0, ball));
  }
};
}  // namespace rolling_edge_ball_rolling_h
namespace rolling_edge_rolling_h {
using Context = RollingContext;
}
namespace rolling_edge_steering_slip_h {
using Context = RollingContext;
}
namespace rolling_rolling_step_h {
struct Context : RollingContext {
  const Wheel wheel = stance->wheels[0].wheel;
};
}  // namespace rolling_rolling_step_h
namespace self_collision_nearest_points_h {
struct Context {
  const Eigen::Vector3d a_from = {0.0, 0.0, 0.0}, a_to = {1.0, 0.0, 0.0}, b_from = {0.5, -1.0, 0.3},
                        b_to = {0.5, 1.0, 0.3};
};
}  // namespace self_collision_nearest_points_h
namespace static_balance_static_rows_h {
/// i: an axis above the wheel.
struct Context : RollingContext {
  const ContactParameter& contact = *stance->contacts[0];
  const double force[3] = {0.0, 0.0, 100.0};
  const double* components = force;
  Eigen::VectorXd e = Eigen::VectorXd::Zero(6);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(robot.tangent_size());
  double* row = gradient.data();
  const int i = robot.support(contact.link).front();
};
}  // namespace static_balance_static_rows_h
namespace static_balance_vertex_wrenches_h {
struct Context : in_plugins::Context {
  Context() { add_wheels({4, 5, 7}); }
};
}  // namespace static_balance_vertex_wrenches_h
namespace surface_distance_edge_surface_distance_h {
struct Context : RollingContext {
  const std::shared_ptr<const RobotParameter>& robot = parameter;
  const VertexId<VertexConfiguration> q = here;
  const World world = small_room();
};
}  // namespace surface_distance_edge_surface_distance_h
namespace surface_distance_place_relations_h {
struct Context : PlacesContext {
  const Stance stance = PlacesContext::stance->stance;
};
}  // namespace surface_distance_place_relations_h
namespace surface_distance_place_rows_h {
struct Context : PlacesContext {
  PlaceRelations relations{places};
  const int link = parameter->bounds[bound].link;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(parameter->robot->tangent_size());
  Context() { relations.set_contacts(stance->stance.contacts); }
};
}  // namespace surface_distance_place_rows_h
namespace surface_distance_places_parameter_h {
struct Context : in_plugins::Context {
  const std::shared_ptr<const RobotParameter>& robot = parameter;
  const World world = small_room();
};
}  // namespace surface_distance_places_parameter_h
namespace surface_distance_touchable_places_h {
struct Context : PlacesContext {
  const std::shared_ptr<const RobotParameter>& robot = parameter;
  const World world = small_room();
};
}  // namespace surface_distance_touchable_places_h
namespace time_step_edge_duration_h {
struct Context : in_plugins::Context {
  const std::vector<VertexId<VertexTimeStep>> steps = {graph.add_vertex(100, VertexTimeStep(0.1)),
                                                       graph.add_vertex(101, VertexTimeStep(0.1))};
};
}  // namespace time_step_edge_duration_h

}  // namespace locograph::documentation::in_plugins
