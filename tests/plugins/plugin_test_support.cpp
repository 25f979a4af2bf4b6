#include "plugins/plugin_test_support.h"

#include <locograph/core/violations.h>

#include <algorithm>
#include <map>

#include "common/sanitized.h"
#include "robots/mimic_robot.h"

namespace locograph::test {

TypeRegistry robot_types() {
  TypeRegistry types;
  add_robot_types(types);
  return types;
}

std::filesystem::path centauro_folder() {
  return std::filesystem::path(LOCOGRAPH_SOURCE_DIR) / "robots/models/centauro";
}

Contact wheel_on_ground(const std::string& link, double radius_m) {
  Contact wheel;
  wheel.effector.name = wheel.effector.link = link;
  wheel.effector.kind = ContactKind::kWheel;
  wheel.effector.radius_m = radius_m;
  wheel.effector.friction = 0.8;
  wheel.effector.max_force_N = 3000.0;
  return wheel;
}

RobotCase centauro(const std::string& name, const RobotOptions& options) {
  RobotCase result{
      name, std::make_shared<const RobotParameter>(centauro_folder() / "centauro.urdf",
                                                   centauro_folder() / "centauro.srdf", options)};
  for (int i = 0; i < 4; ++i) {
    result.wheels.push_back(wheel_on_ground("wheel_" + std::to_string(i + 1), 0.078));
  }
  return result;
}

RobotCase centauro_lower_body() {
  return centauro("CentauroLowerBody", {.active_joints = {"lower_body"}});
}

std::filesystem::path go2_urdf() {
  return std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "robots/go2.urdf";
}

namespace {

RobotCase go2(const std::string& name, bool floating_base) {
  std::filesystem::path srdf = go2_urdf();
  srdf.replace_extension(".srdf");
  const RobotOptions options{.floating_base = floating_base, .lenient_srdf = true};
  return {name, std::make_shared<const RobotParameter>(go2_urdf(), srdf, options)};
}

RobotCase coman_plus(const std::string& name) {
  const std::filesystem::path folder =
      std::filesystem::path(LOCOGRAPH_SOURCE_DIR) / "robots/models/coman_plus";
  return {name, std::make_shared<const RobotParameter>(folder / "coman_plus.urdf",
                                                       folder / "coman_plus.srdf", RobotOptions())};
}

/// An arm with a gripper whose joints follow two active ones.
RobotCase gripper(const std::string& name) {
  static const TemporaryFolder folder;  // plans are read together with the robot's file
  return {name,
          std::make_shared<const RobotParameter>(folder.write("mimic.urdf", mimic_robot_urdf()),
                                                 std::filesystem::path(), RobotOptions())};
}

RobotCase load_robot_case(const std::string& name) {
  if (name == "CentauroLowerBody") return centauro_lower_body();
  if (name == "CentauroAllJoints") return centauro(name, {});
  if (name == "CentauroFixedBase") return centauro(name, {.floating_base = false});
  if (name == "ComanPlus") return coman_plus(name);
  if (name == "Go2FloatingBase") return go2(name, true);
  if (name == "Go2FixedBase") return go2(name, false);
  if (name == "Gripper") return gripper(name);
  throw std::runtime_error("no robot case " + name);
}

}  // namespace

const RobotCase& robot_case(const std::string& name) {
  static std::map<std::string, RobotCase> loaded;
  const auto found = loaded.find(name);
  return found != loaded.end() ? found->second
                               : loaded.emplace(name, load_robot_case(name)).first->second;
}

const std::vector<std::string>& wheeled_cases() {
  static const std::vector<std::string> names = {"CentauroLowerBody", "CentauroAllJoints",
                                                 "CentauroFixedBase"};
  return names;
}

const std::vector<std::string>& all_cases() {
  static const std::vector<std::string> names = {"CentauroLowerBody", "CentauroAllJoints",
                                                 "CentauroFixedBase", "Go2FloatingBase",
                                                 "Go2FixedBase"};
  return names;
}

std::vector<std::string> all_cases_and_coman_plus() {
  std::vector<std::string> names = all_cases();
  names.push_back("ComanPlus");
  return names;
}

bool available(const std::string& name) {
  // Under sanitizers, fitting capsules to its meshes takes longer than all that is tested with
  // them.
  return !name.starts_with("Go2") || (!kSanitized && std::filesystem::exists(go2_urdf()));
}

Eigen::VectorXd home(const RobotCase& robot) {
  Eigen::VectorXd q = robot.model().named_configuration("home");
  if (robot.model().floating_base()) q[2] = 0.7188;
  return q;
}

Eigen::VectorXd home(const RobotCase& robot, double x, double y) {
  Eigen::VectorXd q = home(robot);
  q[0] += x;
  q[1] += y;
  return q;
}

Graph graph_of(const RobotCase& robot) {
  Graph graph;
  graph.parameters().set(kRobot, robot.robot);
  if (robot.wheels.empty()) return graph;
  std::vector<int> numbers;
  for (const Contact& wheel : robot.wheels) {
    numbers.push_back(kWheel + static_cast<int>(numbers.size()));
    graph.parameters().set(numbers.back(),
                           std::make_shared<const ContactParameter>(robot.robot, kRobot, wheel));
  }
  graph.parameters().set(kStance,
                         std::make_shared<const StanceParameter>(graph.parameters(), numbers));
  return graph;
}

EdgeContact wheel_contact(const Graph& graph, int wheel) {
  return EdgeContact(*stance_of(graph)->contacts[static_cast<std::size_t>(wheel)], kWheel + wheel,
                     1.0);
}

EdgeRolling rolling_of(const Graph& graph) { return EdgeRolling(*stance_of(graph), kStance, 1.0); }

EdgeSteeringSlip steering_slip_of(const Graph& graph, double max_slip_m) {
  return EdgeSteeringSlip(*stance_of(graph), kStance, max_slip_m, 1.0);
}

VertexId<VertexConfiguration> add_configuration(Graph& graph, const RobotCase& robot, int id,
                                                double time_s, const Eigen::VectorXd& q) {
  return graph.add_vertex(id, VertexConfiguration(kRobot, robot.robot, time_s, q));
}

Obstacle box_obstacle(const Eigen::Vector3d& centre, const Eigen::Vector3d& size) {
  Obstacle obstacle;
  obstacle.world_from_obstacle.translation() = centre;
  obstacle.size = size;
  return obstacle;
}

std::vector<Obstacle> some_obstacles() {
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

std::shared_ptr<octomap::OcTree> some_map(bool floor) {
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

Eigen::VectorXd Random::vector(Eigen::Index size, double scale) {
  return Eigen::VectorXd::NullaryExpr(size, [&](Eigen::Index) { return uniform(-scale, scale); });
}
Eigen::VectorXd Random::weights(Eigen::Index size) {
  return Eigen::VectorXd::NullaryExpr(size, [&](Eigen::Index) { return uniform(0.1, 5.0); });
}
Eigen::Vector3d Random::direction() {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(engine_), normal(engine_), normal(engine_)).normalized();
}

Eigen::VectorXd Random::configuration(const Robot& robot, double reach, double beyond) {
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
        joint.type == JointType::kContinuous ? uniform(-4.0, 4.0)
                                             : uniform(joint.lower - beyond, joint.upper + beyond);
  }
  return q;
}

void expect_bound_as_own(Graph& graph, const std::shared_ptr<const WorldParameter>& world) {
  Loaded bound(graph);
  EXPECT_EQ(bound.workspace.evaluate(bound.workspace.state()).chi2, 0.0);
  Bindings bindings;
  bindings.set(kWorld, world);
  bound.workspace.bind(bindings);
  const double cost = bound.workspace.evaluate(bound.workspace.state()).chi2;
  bound.workspace.linearise();
  EXPECT_GT(cost, 0.0);
  EXPECT_TRUE(violations(graph).empty());
  EXPECT_FALSE(violations(graph, {}, bindings).empty());
  const auto own = graph.parameters().get<WorldParameter>(kWorld);
  graph.replace_parameter(kWorld, world);
  Loaded replaced(graph);
  EXPECT_EQ(replaced.workspace.evaluate(replaced.workspace.state()).chi2, cost);
  replaced.workspace.linearise();
  EXPECT_EQ(dense_hessian(bound.workspace), dense_hessian(replaced.workspace));
  EXPECT_EQ(dense_gradient(bound.workspace), dense_gradient(replaced.workspace));
  graph.replace_parameter(kWorld, own);
}

Evaluated::Evaluated(Graph& graph) {
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
Eigen::VectorXd Evaluated::error(int k, int pool) {
  const EdgePool& edges = *problem_.graph().edge_pools()[pool];
  Eigen::VectorXd e(edges.dimension(problem_.edges()[pool].edges[k]));
  edges.error(problem_.edges()[pool], k, evaluation_->get(), e.data());
  return e;
}
Eigen::MatrixXd Evaluated::jacobian(int k, int slot, bool numeric, int pool) {
  return problem_.graph().edge_pools()[pool]->jacobian(problem_.edges()[pool], k, slot,
                                                       evaluation_->get(), numeric);
}

}  // namespace locograph::test
