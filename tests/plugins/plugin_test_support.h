#pragma once
/// What the plug-in tests share: robots, random configurations, one graph evaluated edge by edge.
///
///     RobotCase centauro = centauro_lower_body();
///     Graph graph = graph_of(centauro);
///     const VertexId<VertexConfiguration> q = add_configuration(graph, centauro, 0, 0.0, state);
///     graph.add_edge(EdgeJointLimits(centauro.model(), 0.01, 1.0), q);
///     Evaluated evaluated(graph);
///     const Eigen::VectorXd e = evaluated.error(0);          // edge 0 of the only pool

#include <gtest/gtest.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/workspace.h>
#include <locograph/plugins/joint_limits/edge_joint_limits.h>
#include <locograph/plugins/obstacle_distance/edge_obstacle_distance.h>
#include <locograph/plugins/plan_tracking/edge_plan_tracking.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/plugins/rolling/edge_rolling.h>
#include <locograph/plugins/self_collision/edge_self_collision.h>
#include <locograph/plugins/swept_obstacle_distance/edge_swept_obstacle_distance.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits.h>
#include <locograph/plugins/velocity_tracking/edge_velocity_tracking.h>
#include <locograph/plugins/wheel_contact/edge_wheel_contact.h>
#include <locograph/world/octree.h>

#include <map>
#include <random>

#include "common/temporary_folder.h"
#include "core/dense_system.h"

namespace locograph::test {

inline constexpr int kRobot = 0, kWheels = 1, kWorld = 2;

inline TypeRegistry robot_types() {
  TypeRegistry types;
  add_robot_types(types);
  return types;
}

struct RobotCase {
  std::string name;
  std::shared_ptr<const RobotParameter> robot;
  std::shared_ptr<const WheelsParameter> wheels;  ///< null: it has none

  const Robot& model() const { return *robot->robot; }
  int base() const { return model().base_configuration_size(); }
  /// Index into a configuration.
  int at(const std::string& joint) const {
    return base() + model().joints()[model().joint_index(joint)].index;
  }
};

inline std::filesystem::path centauro_folder() {
  return std::filesystem::path(LOCOGRAPH_SOURCE_DIR) / "robots/models/centauro";
}

inline RobotCase centauro(const std::string& name, const RobotOptions& options) {
  RobotCase result{
      name,
      std::make_shared<const RobotParameter>(centauro_folder() / "centauro.urdf",
                                             centauro_folder() / "centauro.srdf", options),
      nullptr};
  std::vector<Wheel> wheels(4);
  for (int i = 0; i < 4; ++i) {
    wheels[i].link_name = "wheel_" + std::to_string(i + 1);
    wheels[i].radius_m = 0.078;
  }
  result.wheels = std::make_shared<const WheelsParameter>(result.model(), kRobot, wheels);
  return result;
}
inline RobotCase centauro_lower_body() {
  return centauro("CentauroLowerBody", {.active_joints = {"lower_body"}});
}

inline std::filesystem::path go2_urdf() {
  return std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "robots/go2.urdf";
}
inline RobotCase go2(const std::string& name, bool floating_base) {
  std::filesystem::path srdf = go2_urdf();
  srdf.replace_extension(".srdf");
  const RobotOptions options{.floating_base = floating_base, .lenient_srdf = true};
  return {name, std::make_shared<const RobotParameter>(go2_urdf(), srdf, options), nullptr};
}

inline RobotCase coman_plus(const std::string& name) {
  const std::filesystem::path folder =
      std::filesystem::path(LOCOGRAPH_SOURCE_DIR) / "robots/models/coman_plus";
  return {name,
          std::make_shared<const RobotParameter>(folder / "coman_plus.urdf",
                                                 folder / "coman_plus.srdf", RobotOptions()),
          nullptr};
}

inline RobotCase load_robot_case(const std::string& name) {
  if (name == "CentauroLowerBody") return centauro_lower_body();
  if (name == "CentauroAllJoints") return centauro(name, {});
  if (name == "CentauroFixedBase") return centauro(name, {.floating_base = false});
  if (name == "ComanPlus") return coman_plus(name);
  if (name == "Go2FloatingBase") return go2(name, true);
  if (name == "Go2FixedBase") return go2(name, false);
  throw std::runtime_error("no robot case " + name);
}
/// Loaded once: covering a robot with spheres takes longer than most tests.
inline const RobotCase& robot_case(const std::string& name) {
  static std::map<std::string, RobotCase> loaded;
  const auto found = loaded.find(name);
  return found != loaded.end() ? found->second
                               : loaded.emplace(name, load_robot_case(name)).first->second;
}
inline const std::vector<std::string>& wheeled_cases() {
  static const std::vector<std::string> names = {"CentauroLowerBody", "CentauroAllJoints",
                                                 "CentauroFixedBase"};
  return names;
}
inline const std::vector<std::string>& all_cases() {
  static const std::vector<std::string> names = {"CentauroLowerBody", "CentauroAllJoints",
                                                 "CentauroFixedBase", "Go2FloatingBase",
                                                 "Go2FixedBase"};
  return names;
}
/// These and COMAN+, which has limbs all round and no wheels.
inline std::vector<std::string> all_cases_and_coman_plus() {
  std::vector<std::string> names = all_cases();
  names.push_back("ComanPlus");
  return names;
}
inline bool available(const std::string& name) {
  return !name.starts_with("Go2") || std::filesystem::exists(go2_urdf());
}

/// CENTAURO standing on its wheels at the origin, heading along x.
inline Eigen::VectorXd home(const RobotCase& robot) {
  Eigen::VectorXd q = robot.model().named_configuration("home");
  if (robot.model().floating_base()) q[2] = 0.7188;
  return q;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  double sign() { return uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0; }
  Eigen::VectorXd vector(Eigen::Index size, double scale) {
    return Eigen::VectorXd::NullaryExpr(size, [&](Eigen::Index) { return uniform(-scale, scale); });
  }
  Eigen::VectorXd weights(Eigen::Index size) {
    return Eigen::VectorXd::NullaryExpr(size, [&](Eigen::Index) { return uniform(0.1, 5.0); });
  }
  Eigen::Vector3d direction() {
    std::normal_distribution<double> normal;
    return Eigen::Vector3d(normal(engine_), normal(engine_), normal(engine_)).normalized();
  }

  /// Base within `reach` of the origin with any orientation; joints anywhere from `beyond` outside
  /// their lower limit to `beyond` outside their upper one.
  Eigen::VectorXd configuration(const Robot& robot, double reach, double beyond) {
    Eigen::VectorXd q(robot.configuration_size());
    if (robot.floating_base()) {
      q.head<3>() = vector(3, reach);
      std::normal_distribution<double> normal;
      for (int i = 3; i < 7; ++i) q[i] = normal(engine_);
      q.segment<4>(3).normalize();
    }
    for (int i = 0; i < robot.active_joint_count(); ++i) {
      const Joint& joint = robot.active_joint(i);
      q[robot.base_configuration_size() + i] =
          joint.type == JointType::kContinuous
              ? uniform(-4.0, 4.0)
              : uniform(joint.lower - beyond, joint.upper + beyond);
    }
    return q;
  }

 private:
  std::mt19937 engine_;
};

/// An empty graph that knows the robot and its wheels.
inline Graph graph_of(const RobotCase& robot) {
  Graph graph;
  graph.parameters().set(kRobot, robot.robot);
  if (robot.wheels) graph.parameters().set(kWheels, robot.wheels);
  return graph;
}

inline VertexId<VertexConfiguration> add_configuration(Graph& graph, const RobotCase& robot, int id,
                                                       double time_s, const Eigen::VectorXd& q) {
  return graph.add_vertex(id, VertexConfiguration(kRobot, robot.robot, time_s, q));
}

/// A graph compiled and evaluated at its own state.
class Evaluated {
 public:
  explicit Evaluated(Graph& graph) {
    problem_.compile(graph);
    std::vector<double> state(problem_.state_size());
    for (std::size_t p = 0; p < problem_.active().size(); ++p) {
      for (const ActiveVertex& v : problem_.active()[p]) {
        const VertexPool& pool = *graph.vertex_pools()[p];
        std::copy_n(pool.state(v.index), pool.state_size(v.index), state.data() + v.state_offset);
      }
    }
    evaluation_ = std::make_unique<StateEvaluation>(problem_, state);
  }

  int edges(int pool = 0) const { return static_cast<int>(problem_.edges()[pool].edges.size()); }
  Eigen::VectorXd error(int k, int pool = 0) {
    const EdgePool& edges = *problem_.graph().edge_pools()[pool];
    Eigen::VectorXd e(edges.dimension(problem_.edges()[pool].edges[k]));
    edges.error(problem_.edges()[pool], k, evaluation_->get(), e.data());
    return e;
  }
  Eigen::MatrixXd jacobian(int k, int slot, bool numeric, int pool = 0) {
    return problem_.graph().edge_pools()[pool]->jacobian(problem_.edges()[pool], k, slot,
                                                         evaluation_->get(), numeric);
  }

 private:
  Problem problem_;
  std::unique_ptr<StateEvaluation> evaluation_;
};

/// Error of one edge on the given configurations, at their times.
template <class E>
Eigen::VectorXd error_of(const RobotCase& robot, const E& edge, const Eigen::VectorXd& q,
                         double time_s = 0.0,
                         std::shared_ptr<const WorldParameter> world = nullptr) {
  Graph graph = graph_of(robot);
  if (world) graph.parameters().set(kWorld, world);
  graph.add_edge(edge, add_configuration(graph, robot, 0, time_s, q));
  return Evaluated(graph).error(0);
}
template <class E>
Eigen::VectorXd error_between(const RobotCase& robot, const E& edge, const Eigen::VectorXd& a,
                              const Eigen::VectorXd& b, double dt_s = 1.0) {
  Graph graph = graph_of(robot);
  const auto from = add_configuration(graph, robot, 0, 0.0, a);
  const auto to = add_configuration(graph, robot, 1, dt_s, b);
  graph.add_edge(edge, from, to);
  return Evaluated(graph).error(0);
}

/// Sphere, box, cylinder and a moving, turning box around the origin.
inline std::vector<Obstacle> some_obstacles() {
  std::vector<Obstacle> obstacles(5);
  obstacles[0].shape = Obstacle::Shape::kSphere;
  obstacles[0].world_from_obstacle.translation() << 0.7, 0.3, 0.2;
  obstacles[0].size << 0.3, 0.0, 0.0;
  obstacles[1].shape = Obstacle::Shape::kBox;
  obstacles[1].world_from_obstacle.translation() << -0.6, 0.4, -0.3;
  obstacles[1].world_from_obstacle.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.36, 0.48, 0.8)));
  obstacles[1].size << 0.5, 0.8, 0.4;
  obstacles[2].shape = Obstacle::Shape::kCylinder;
  obstacles[2].world_from_obstacle.translation() << 0.1, -0.8, 0.3;
  obstacles[2].world_from_obstacle.rotate(Eigen::AngleAxisd(-0.5, Eigen::Vector3d(0.6, 0.0, 0.8)));
  obstacles[2].size << 0.25, 0.9, 0.0;
  obstacles[3].shape = Obstacle::Shape::kBox;
  obstacles[3].world_from_obstacle.translation() << 1.5, -1.0, 0.5;
  obstacles[3].size << 0.4, 0.3, 0.6;
  KeyFrame frame;
  frame.time_s = 10.0;
  frame.pose.translation() << -1.0, 1.2, -0.4;
  frame.pose.rotate(Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitZ()));
  obstacles[3].motion.push_back(frame);
  obstacles[4].shape = Obstacle::Shape::kCylinder;
  obstacles[4].world_from_obstacle.translation() << -0.3, -0.1, 0.9;
  obstacles[4].size << 0.2, 0.3, 0.0;
  for (const Obstacle& obstacle : obstacles) obstacle.validate();
  return obstacles;
}

/// A map of boxes around the origin, the floor z < 0 among them when asked for.
inline std::shared_ptr<octomap::OcTree> some_map(bool floor) {
  std::vector<Box> boxes(floor ? 5 : 4);
  boxes[0].world_from_box.translation() << 0.8, 0.0, 0.3;
  boxes[0].size << 0.3, 1.2, 0.8;
  boxes[1].world_from_box.translation() << -0.5, 0.9, 0.2;
  boxes[1].size << 0.9, 0.3, 0.4;
  boxes[2].world_from_box.translation() << -0.4, -0.7, 0.8;
  boxes[2].world_from_box.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  boxes[2].size << 0.4, 0.5, 0.4;
  boxes[3].world_from_box.translation() << 0.2, 0.3, -0.2;
  boxes[3].size << 0.3, 0.2, 0.3;
  if (floor) {
    boxes[4].world_from_box.translation() << 0.0, 0.0, -0.05;
    boxes[4].size << 4.0, 4.0, 0.09;
  }
  return octree_from_boxes(boxes, 0.05);
}

}  // namespace locograph::test
