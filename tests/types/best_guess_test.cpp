#include <gtest/gtest.h>
#include <locograph/core/initial_guess.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/best_guess.h>
#include <locograph/types/slam2d/edges.h>

#include <numbers>
#include <random>

#include "core/cost_of.h"

namespace locograph {
namespace {

/// A circle driven twice, the second lap tied to the first.
struct TwoLaps {
  static constexpr int kLap = 40;
  Graph graph;
  std::vector<SE2<double>> truth;
  std::vector<VertexId<VertexSE2>> poses;
  std::mt19937 engine{3};

  explicit TwoLaps(double heading_noise) {
    const SE2<double> motion(1.0, 0.0, 2.0 * std::numbers::pi / kLap);
    std::normal_distribution<double> normal(0.0, heading_noise);
    for (int i = 0; i < 2 * kLap; ++i) {
      truth.push_back(i == 0 ? SE2<double>() : truth.back() * motion);
      poses.push_back(graph.add_vertex(i, VertexSE2(truth.back())));
      if (i > 0) tie(i - 1, i, normal(engine));
      if (i >= kLap) tie(i - kLap, i, normal(engine));
    }
    graph.set_fixed(poses[0], true);
  }
  void tie(int a, int b, double error) {
    EdgeSE2 edge;
    edge.measurement = truth[a].inverse() * truth[b] * SE2<double>(0.0, 0.0, error);
    edge.information = Eigen::Vector3d(100.0, 100.0, 100.0).asDiagonal();
    graph.add_edge(edge, poses[a], poses[b]);
  }
  void scatter() {
    std::normal_distribution<double> normal;
    for (std::size_t i = 1; i < poses.size(); ++i) {
      graph.vertex(poses[i]) = VertexSE2(SE2<double>(normal(engine), normal(engine), 0.0));
    }
  }
  double cost() { return test::cost_of(graph).robust; }
  BestGuess take(const BestGuessOptions& options = {}) {
    Problem problem;
    problem.compile(graph);
    Workspace workspace;
    workspace.allocate(problem);
    const BestGuess best = take_best_guess(workspace, *make_linear_solver("auto"), options);
    EXPECT_EQ(workspace.evaluate(workspace.state()).robust, best.cost);
    EXPECT_EQ(cost(), best.cost) << "the graph holds other values than the workspace";
    return best;
  }
};

TEST(BestGuess, KeepsGoodValuesToTheBit) {
  TwoLaps laps(0.01);
  EXPECT_EQ(laps.take().taken, "none");
  for (std::size_t i = 0; i < laps.poses.size(); ++i) {
    EXPECT_EQ(laps.graph.vertex(laps.poses[i]).state, VertexSE2(laps.truth[i]).state);
  }
}

TEST(BestGuess, WalksAlongTheEdgesWhereTheValuesAreWorse) {
  TwoLaps laps(0.001);
  laps.scatter();
  const double scattered = laps.cost();
  const BestGuess best = laps.take();
  EXPECT_TRUE(best.taken == "odometry" || best.taken == "spanning-tree") << best.taken;
  EXPECT_LT(best.cost, 1e-3 * scattered);
  EXPECT_EQ(best.unreached, 0);
}

TEST(BestGuess, RelaxesWhereTheWalksArePoorToo) {
  TwoLaps laps(0.2), walked(0.2);
  laps.scatter();
  EXPECT_EQ(laps.take().taken, "chordal");
  guess_from_odometry(walked.graph);
  EXPECT_LT(laps.cost(), walked.cost());
  guess_from_spanning_tree(walked.graph);
  EXPECT_LT(laps.cost(), walked.cost());
}

TEST(BestGuess, DoesNotCountValuesThatNobodyGave) {
  TwoLaps laps(0.01);
  EXPECT_NE(laps.take({.use_present = false}).taken, "none");
}

TEST(BestGuess, LeavesOutWhatItIsToldTo) {
  TwoLaps laps(0.2), other(0.2);
  laps.scatter();
  other.scatter();
  const std::vector<int> closures = {2 * TwoLaps::kLap};
  ASSERT_EQ(laps.take().taken, "chordal");
  ASSERT_EQ(other.take({.left_out = closures}).taken, "chordal");
  EXPECT_NE(laps.cost(), other.cost());
}

}  // namespace
}  // namespace locograph
