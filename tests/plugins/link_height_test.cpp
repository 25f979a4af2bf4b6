#include <locograph/plugins/ground_distance/edge_link_height.h>
#include <locograph/world/collision_world.h>

#include "plugins/bad_line.h"
#include "plugins/jacobian_comparison.h"

namespace locograph::test {
namespace {

class LinkHeight : public RobotCaseTest {
 protected:
  static constexpr double kMargin = 0.05;
  std::vector<std::string> links_with_shapes() const {
    std::vector<std::string> names;
    for (const Link& link : robot.model().links())
      if (!link.collision.empty()) names.push_back(link.name);
    return names;
  }
  LinkSolids solids(const std::string& name) const {
    return LinkSolids(robot.model(), robot.model().link_index(name));
  }
  double height(const std::string& name, const Eigen::VectorXd& q) const {
    ConfigurationState state(robot.robot);
    state.update(q.data());
    const int link = robot.model().link_index(name);
    return solids(name).lowest_point(state.kinematics.world_from_link(link)).z();
  }
  EdgeLinkHeight edge(const std::string& name, double margin = kMargin) const {
    return EdgeLinkHeight(kRobot, name, margin, 1.0);
  }
};

TEST_P(LinkHeight, TheLowestPointOfAllLinksIsTheDistanceToTheGround) {
  Random random(161);
  World world;
  world.surfaces = {ground()};
  const CollisionWorld exact(robot.model(), world);
  for (int i = 0; i < 10; ++i) {
    Eigen::VectorXd q = random.configuration(robot.model(), 1.0, 0.0);
    double lowest = std::numeric_limits<double>::infinity();
    for (const std::string& name : links_with_shapes()) lowest = std::min(lowest, height(name, q));
    ConfigurationState state(robot.robot);
    state.update(q.data());
    std::vector<Eigen::Isometry3d> poses;
    for (int link = 0; link < static_cast<int>(robot.model().links().size()); ++link)
      poses.push_back(state.kinematics.world_from_link(link));
    const double distance = exact.surroundings({.world_from_link = poses}).surface.distance_m;
    if (lowest < 0.15) {
      EXPECT_NEAR(lowest, distance, 1e-12);
    }
  }
}

TEST_P(LinkHeight, IsWhatTheMarginLacksAndNothingWithoutShapes) {
  Random random(162);
  int violated = 0, held = 0;
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd q = random.configuration(robot.model(), 1.0, 0.0);
    for (const Link& link : robot.model().links()) {
      const double e = error_of(robot, edge(link.name), q)[0];
      if (link.collision.empty()) {
        ASSERT_EQ(e, 0.0);
        continue;
      }
      ASSERT_NEAR(e, std::max(0.0, kMargin - height(link.name, q)), 1e-12);
      (e > 0.0 ? violated : held) += 1;
    }
  }
  EXPECT_GT(violated, 20);
  EXPECT_GT(held, 20);
}

TEST_P(LinkHeight, HasTheJacobianOfNumericDifferences) {
  Random random(163);
  Graph graph = graph_of(robot);
  const std::vector<std::string> names = links_with_shapes();
  std::vector<double> heights;
  for (int i = 0; i < kStates; ++i) {
    const Eigen::VectorXd q = random.configuration(robot.model(), 1.0, 0.0);
    const std::string& name = names[static_cast<std::size_t>(i) % names.size()];
    graph.add_edge(edge(name), add_configuration(graph, robot, i, 0.0, q));
    heights.push_back(height(name, q));
  }
  Evaluated evaluated(graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) {
    compare(
        evaluated, k, 0,
        [&](int) { return std::abs(heights[static_cast<std::size_t>(k)] - kMargin) > kKink; },
        compared);
  }
  EXPECT_GT(compared.nonzero, 0);
  EXPECT_GT(compared.zero, 0);
}

TEST_P(LinkHeight, AllEdgesAtOnceEqualOneByOne) {
  Random random(164);
  Graph graph = graph_of(robot);
  double sum = 0.0;
  const Eigen::VectorXd q = random.configuration(robot.model(), 1.0, 0.0);
  int number = 0;
  for (const std::string& name : links_with_shapes()) {
    const EdgeLinkHeight above(kRobot, name, 0.1, 2.0);
    sum += 2.0 * error_of(robot, above, q).squaredNorm();
    graph.add_edge(above, add_configuration(graph, robot, number++, 0.0, q));
  }
  Loaded loaded(graph);
  EXPECT_NEAR(loaded.workspace.evaluate(loaded.workspace.state()).chi2, sum, 1e-9 * sum + 1e-300);
  expect_batch_equals_one_by_one(loaded.workspace, 1e-12);
}

TEST_P(LinkHeight, ComesBackFromAFileWithTheSameBits) {
  Random random(165);
  Graph graph = graph_of(robot);
  const std::string name = links_with_shapes().back();
  graph.add_edge(
      EdgeLinkHeight(kRobot, name, 0.1 / 3.0, 2.0 / 3.0),
      add_configuration(graph, robot, 0, 0.0, random.configuration(robot.model(), 1.0, 0.0)));
  const TemporaryFolder folder;
  write_graph(graph, folder.file("height.g2o"));
  Graph again = read_graph(folder.file("height.g2o"), robot_types());
  ASSERT_EQ(again.edge_count(), 1);
  const EdgeLinkHeight& read = again.edge<EdgeLinkHeight>(EdgeId{0});
  EXPECT_EQ(read.link_name, name);
  EXPECT_EQ(read.margin_m, 0.1 / 3.0);
  EXPECT_EQ(read.weights[0], 2.0 / 3.0);
}

INSTANTIATE_TEST_SUITE_P(Robots, LinkHeight, testing::ValuesIn(all_cases()), robot_case_name);

TEST(LinkHeightFiles, ALineThatDoesNotFitIsRefusedWithItsNumber) {
  const RobotCase robot = centauro_lower_body();
  const TemporaryFolder folder;
  Graph graph = graph_of(robot);
  add_configuration(graph, robot, 0, 0.0, home(robot));
  write_graph(graph, folder.file("good.g2o"));
  std::ifstream in(folder.file("good.g2o"));
  const std::string good((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::string number = std::to_string(kRobot);
  const auto refused = [&](const std::string& line, const char* words) {
    expect_bad_line(folder, good, {"", line.c_str(), words});
  };
  refused("EDGE_LINK_HEIGHT 0 " + number + " no_such_link 0.1 scalar 1", "no_such_link");
  refused("EDGE_LINK_HEIGHT 0 77 ankle2_1 0.1 scalar 1", "77");
  refused("EDGE_LINK_HEIGHT 0 " + number + " ankle2_1 nan scalar 1", "'nan' is not finite");
  refused("EDGE_LINK_HEIGHT 0 " + number + " ankle2_1", "too few fields");
}

}  // namespace
}  // namespace locograph::test
