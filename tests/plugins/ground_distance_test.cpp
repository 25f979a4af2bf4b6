#include <locograph/plugins/ground_distance/edge_ground_distance.h>

#include "plugins/bad_line.h"
#include "plugins/jacobian_comparison.h"

namespace locograph::test {
namespace {

class GroundDistance : public RobotCaseTest {
 protected:
  static constexpr double kMargin = 0.05;
  /// Lowest points of the spheres above the ground.
  std::vector<double> heights(const Eigen::VectorXd& q) const {
    ConfigurationState state(robot.robot);
    state.update(q.data());
    std::vector<double> result;
    for (Eigen::Index i = 0; i < state.sphere_centres.rows(); ++i) {
      result.push_back(state.sphere_centre(i).z() - robot.robot->spheres[i].radius);
    }
    return result;
  }
};

TEST_P(GroundDistance, IsWhatTheMarginLacksForEverySphere) {
  Random random(61);
  const EdgeGroundDistance edge(*robot.robot, kMargin, 1.0);
  int violated = 0, rows = 0;
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd q = random.configuration(robot.model(), 1.0, 0.0);
    const Eigen::VectorXd e = error_of(robot, edge, q);
    const std::vector<double> height = heights(q);
    ASSERT_EQ(e.size(), static_cast<Eigen::Index>(height.size()));
    for (Eigen::Index s = 0; s < e.size(); ++s) {
      ASSERT_NEAR(e[s], std::max(0.0, kMargin - height[static_cast<std::size_t>(s)]), 1e-12);
      violated += e[s] > 0.0;
    }
    rows += static_cast<int>(e.size());
  }
  EXPECT_GT(violated, 20);
  EXPECT_LT(violated, rows - 20);
}

TEST_P(GroundDistance, HasTheJacobianOfNumericDifferences) {
  Random random(62);
  Graph graph = graph_of(robot);
  std::vector<std::vector<double>> height;
  for (int i = 0; i < kStates; ++i) {
    const Eigen::VectorXd q = random.configuration(robot.model(), 1.0, 0.0);
    graph.add_edge(EdgeGroundDistance(*robot.robot, kMargin, 1.0),
                   add_configuration(graph, robot, i, 0.0, q));
    height.push_back(heights(q));
  }
  Evaluated evaluated(graph);
  Compared compared;
  for (int k = 0; k < kStates; ++k) {
    compare(
        evaluated, k, 0,
        [&](int row) {
          return std::abs(height[static_cast<std::size_t>(k)][static_cast<std::size_t>(row)] -
                          kMargin) > kKink;
        },
        compared);
  }
  EXPECT_GT(compared.nonzero, kStates);
  EXPECT_GT(compared.zero, kStates);
}

TEST_P(GroundDistance, AllEdgesAtOnceEqualOneByOne) {
  Random random(63);
  const Eigen::VectorXd q = random.configuration(robot.model(), 1.0, 0.0);
  Graph graph = graph_of(robot);
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    EdgeGroundDistance edge(*robot.robot, 0.1 * i, 1.0 + i);
    const Eigen::VectorXd e = error_of(robot, edge, q);
    sum += (1.0 + i) * e.squaredNorm();
    graph.add_edge(edge, add_configuration(graph, robot, i, 0.0, q));
  }
  Loaded loaded(graph);
  EXPECT_NEAR(loaded.workspace.evaluate(loaded.workspace.state()).chi2, sum, 1e-9 * sum);
  expect_batch_equals_one_by_one(loaded.workspace, 1e-12);
}

TEST_P(GroundDistance, ComesBackFromAFileWithTheSameBits) {
  Random random(64);
  Graph graph = graph_of(robot);
  EdgeGroundDistance edge(*robot.robot, 0.1 / 3.0, 1.0);
  edge.weights = random.weights(edge.weights.size());
  graph.add_edge(
      edge, add_configuration(graph, robot, 0, 0.0, random.configuration(robot.model(), 1.0, 0.0)));
  const TemporaryFolder folder;
  write_graph(graph, folder.file("ground.g2o"));
  Graph again = read_graph(folder.file("ground.g2o"), robot_types());
  ASSERT_EQ(again.edge_count(), 1);
  const EdgeGroundDistance& read = again.edge<EdgeGroundDistance>(EdgeId{0});
  EXPECT_EQ(read.margin_m, edge.margin_m);
  EXPECT_EQ(read.weights, edge.weights);
}

INSTANTIATE_TEST_SUITE_P(Robots, GroundDistance, testing::ValuesIn(all_cases()), robot_case_name);

TEST(GroundDistanceFiles, ALineThatDoesNotFitIsRefusedWithItsNumber) {
  const RobotCase robot = centauro_lower_body();
  const TemporaryFolder folder;
  Graph graph = graph_of(robot);
  add_configuration(graph, robot, 0, 0.0, home(robot));
  write_graph(graph, folder.file("good.g2o"));
  std::ifstream in(folder.file("good.g2o"));
  const std::string good((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::string rows = std::to_string(robot.robot->spheres.size());
  const auto refused = [&](const std::string& line, const char* words) {
    expect_bad_line(folder, good, {"", line.c_str(), words});
  };
  refused("EDGE_GROUND_DISTANCE 0 3 0.1 scalar 1", "n = 3");
  refused("EDGE_GROUND_DISTANCE 0 " + rows + " nan scalar 1", "'nan' is not finite");
  refused("EDGE_GROUND_DISTANCE 0 " + rows, "too few fields");
}

}  // namespace
}  // namespace locograph::test
