// EDGE_BALL_ROLLING: Jacobian, file, labels, and contacts that no ball has.
#include <locograph/plugins/rolling/edge_ball_rolling.h>

#include <string>

#include "plugins/legged_cases.h"

namespace locograph::test {
namespace {

constexpr int kBall = 30;

Contact ball_at(const RobotCase& robot, const Eigen::VectorXd& q, bool on_bar) {
  Contact contact;
  contact.effector = {.name = "hand", .link = "LBall", .kind = ContactKind::kPoint};
  contact.effector.point = {0.0, 0.0, -0.0105};
  contact.effector.radius_m = 0.071;
  contact.effector.friction = 0.5;
  contact.effector.max_force_N = 100.0;
  contact.normal = {0.2, -0.3, 1.0};
  RobotState state(robot.model());
  state.update(q.data());
  const BallPose pose(state, contact.effector);
  contact.position = pose.centre - 0.071 * contact.normal.normalized();
  if (on_bar) contact.bar = RoundBar{contact.normal.cross(Eigen::Vector3d::UnitX()), 0.02};
  return contact;
}

Graph two_configurations(bool on_bar) {
  const RobotCase robot = robot_case("ComanPlus");
  Random random(8);
  Graph graph = graph_of(robot);
  const Eigen::VectorXd from = random.configuration(robot.model(), 1.0, 0.0);
  graph.parameters().set(kBall, std::make_shared<const ContactParameter>(
                                    robot.robot, kRobot, ball_at(robot, from, on_bar)));
  const Eigen::VectorXd step = random.vector(robot.model().tangent_size(), 0.1);
  Eigen::VectorXd to(from.size());
  robot.model().integrate(from.data(), step.data(), to.data());
  graph.add_edge(EdgeBallRolling(kBall, 2.0), add_configuration(graph, robot, 0, 0.0, from),
                 add_configuration(graph, robot, 1, 0.1, to));
  return graph;
}

class BallRolling : public testing::TestWithParam<bool> {};

TEST_P(BallRolling, HasTheJacobianOfNumericDifferences) {
  Graph graph = two_configurations(GetParam());
  Evaluated evaluated(graph);
  for (const int slot : {0, 1}) {
    const Eigen::MatrixXd exact = evaluated.jacobian(0, slot, false);
    EXPECT_GT(exact.norm(), 0.1);
    EXPECT_LT((exact - evaluated.jacobian(0, slot, true)).norm(), 1e-6);
  }
}

TEST_P(BallRolling, IsTheSameAfterAFile) {
  Graph graph = two_configurations(GetParam());
  const std::string text = write_graph_text(graph);
  Graph read = read_graph_text(text, "balls.g2o", {}, robot_types());
  EXPECT_EQ(write_graph_text(read), text);
  EXPECT_EQ(text.find(" bar 0.02") != std::string::npos, GetParam());
  EXPECT_LT((Evaluated(graph).error(0) - Evaluated(read).error(0)).norm(), 1e-15);
}

INSTANTIATE_TEST_SUITE_P(OnAPlaneAndABar, BallRolling, testing::Bool(),
                         [](const auto& of) { return of.param ? "Bar" : "Plane"; });

TEST(BallRollingEdge, NamesItsRowsAndRefusesWhatIsNoBall) {
  Graph graph = two_configurations(false);
  EdgeBallRolling edge(kBall, 1.0);
  edge.bind(graph.parameters());
  EXPECT_EQ(edge.row_label(0).name, "hand slip x");
  EXPECT_EQ(edge.row_label(2).name, "hand height");
  const RobotCase robot = robot_case("ComanPlus");
  Contact bare = graph.parameters().get<ContactParameter>(kBall)->contact;
  bare.effector.radius_m = 0.0;
  graph.parameters().set(
      31, std::make_shared<const ContactParameter>(robot.robot, kRobot, std::move(bare)));
  EXPECT_THROW(EdgeBallRolling(31, 1.0).bind(graph.parameters()), locograph::Error);
}

}  // namespace
}  // namespace locograph::test
