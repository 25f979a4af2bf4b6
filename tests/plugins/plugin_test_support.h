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
#include <locograph/common/uniform.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/workspace.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/plugins/contact/edge_contact.h>
#include <locograph/plugins/joint_limits/edge_joint_limits.h>
#include <locograph/plugins/obstacle_distance/edge_obstacle_distance.h>
#include <locograph/plugins/plan_tracking/edge_plan_tracking.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/plugins/rolling/edge_rolling.h>
#include <locograph/plugins/rolling/edge_steering_slip.h>
#include <locograph/plugins/self_collision/edge_self_collision.h>
#include <locograph/plugins/swept_obstacle_distance/edge_swept_obstacle_distance.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits.h>
#include <locograph/plugins/velocity_tracking/edge_acceleration_tracking.h>
#include <locograph/plugins/velocity_tracking/edge_velocity_tracking.h>
#include <locograph/world/octree.h>

#include <random>

#include "common/temporary_folder.h"
#include "core/dense_system.h"

namespace locograph::test {

/// Parameters; a stance comes after its contacts.
inline constexpr int kRobot = 0, kPlan = 1, kWorld = 2, kWheel = 100, kStance = 120;

TypeRegistry robot_types();

struct RobotCase {
  std::string name;
  std::shared_ptr<const RobotParameter> robot;
  std::vector<Contact> wheels = {};  ///< on the ground; empty: it has none

  const Robot& model() const { return *robot->robot; }
  int base() const { return model().base_configuration_size(); }
  /// Index into a configuration.
  int at(const std::string& joint) const {
    return base() + model().joints()[model().joint_index(joint)].index;
  }
};

std::filesystem::path centauro_folder();

RobotCase centauro(const std::string& name, const RobotOptions& options);
RobotCase centauro_lower_body();

std::filesystem::path go2_urdf();

/// Loaded once: covering a robot with spheres takes longer than most tests.
const RobotCase& robot_case(const std::string& name);
const std::vector<std::string>& wheeled_cases();
const std::vector<std::string>& all_cases();
/// These and COMAN+, which has limbs all round and no wheels.
std::vector<std::string> all_cases_and_coman_plus();
bool available(const std::string& name);

/// Tests of a robot by the name of its case.
class RobotCaseTest : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!available(GetParam())) GTEST_SKIP() << GetParam() << " is not tested here";
    robot = robot_case(GetParam());
  }
  RobotCase robot;
};
inline std::string robot_case_name(const testing::TestParamInfo<std::string>& info) {
  return info.param;
}

/// CENTAURO standing on its wheels at the origin, heading along x.
Eigen::VectorXd home(const RobotCase& robot);

/// `home` moved by x and y [m].
Eigen::VectorXd home(const RobotCase& robot, double x, double y);

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) { return locograph::uniform(engine_, low, high); }
  double sign() { return uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0; }
  Eigen::VectorXd vector(Eigen::Index size, double scale);
  Eigen::VectorXd weights(Eigen::Index size);
  Eigen::Vector3d direction();

  /// Base within `reach` of the origin with any orientation; joints anywhere from `beyond` outside
  /// their lower limit to `beyond` outside their upper one.
  Eigen::VectorXd configuration(const Robot& robot, double reach, double beyond);

 private:
  std::mt19937 engine_;
};

/// An empty graph that knows the robot and the stance on its wheels: contacts kWheel and on, stance
/// kStance.
Graph graph_of(const RobotCase& robot);
inline std::shared_ptr<const StanceParameter> stance_of(const Graph& graph) {
  return graph.parameters().get<StanceParameter>(kStance);
}
/// Of one of the wheels.
EdgeContact wheel_contact(const Graph& graph, int wheel);
/// Rolling on all of them.
EdgeRolling rolling_of(const Graph& graph);
EdgeSteeringSlip steering_slip_of(const Graph& graph, double max_slip_m);

/// A wheel on the ground.
Contact wheel_on_ground(const std::string& link, double radius_m);

VertexId<VertexConfiguration> add_configuration(Graph& graph, const RobotCase& robot, int id,
                                                double time_s, const Eigen::VectorXd& q);

/// A graph compiled and evaluated at its own state.
class Evaluated {
 public:
  explicit Evaluated(Graph& graph);
  int edges(int pool = 0) const { return static_cast<int>(problem_.edges()[pool].edges.size()); }
  Eigen::VectorXd error(int k, int pool = 0);
  Eigen::MatrixXd jacobian(int k, int slot, bool numeric, int pool = 0);

 private:
  Problem problem_;
  std::unique_ptr<StateEvaluation> evaluation_;
};

/// Of a graph whose world is in no edge's way: with `world` bound, it evaluates and linearises to
/// the same bits as with that world as its own, to others than without.
void expect_bound_as_own(Graph& graph, const std::shared_ptr<const WorldParameter>& world);

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

Obstacle box_obstacle(const Eigen::Vector3d& centre, const Eigen::Vector3d& size);

/// A PARAMS_WORLD that was read from no files.
inline std::shared_ptr<const WorldParameter> world_of(
    std::vector<Obstacle> obstacles, std::shared_ptr<const octomap::OcTree> map = nullptr) {
  return std::make_shared<const WorldParameter>(std::make_shared<const WorldSnapshot>(
      World{.map = std::move(map), .obstacles = std::move(obstacles)}));
}

/// Sphere, box, cylinder and a moving, turning box around the origin.
std::vector<Obstacle> some_obstacles();

/// A map of boxes around the origin, the floor z < 0 among them when asked for.
std::shared_ptr<octomap::OcTree> some_map(bool floor);

}  // namespace locograph::test
