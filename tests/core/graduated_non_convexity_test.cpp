#include <gtest/gtest.h>
#include <locograph/core/graduated_non_convexity.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/initial_guess.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/standard_types.h>

#include "benchmarks/core/false_loop_closures.h"
#include "core/dense_system.h"
#include "core/toy_graphs.h"

namespace locograph {
namespace {

using test::helix_3d;
using test::ring_2d;

TEST(ChiSquared, QuantilesAreThoseOfTheTables) {
  EXPECT_NEAR(chi_squared_quantile(1, 0.95), 3.841458820694124, 1e-12);
  EXPECT_NEAR(chi_squared_quantile(2, 0.99), 9.210340371976182, 1e-12);
  EXPECT_NEAR(chi_squared_quantile(3, 0.99), 11.344866730144373, 1e-12);
  EXPECT_NEAR(chi_squared_quantile(6, 0.5), 5.348120627447122, 1e-12);
  EXPECT_NEAR(chi_squared_quantile(30, 0.999), 59.70306430442993, 1e-10);
}

class EitherGraduation : public testing::TestWithParam<Graduation> {
 protected:
  GraduationOptions options() const {
    GraduationOptions options;
    options.kind = GetParam();
    return options;
  }
};
INSTANTIATE_TEST_SUITE_P(Graduation, EitherGraduation,
                         testing::Values(Graduation::kTruncated, Graduation::kGemanMcClure),
                         [](const auto& info) {
                           return info.param == Graduation::kTruncated ? "Truncated"
                                                                       : "GemanMcClure";
                         });

TEST_P(EitherGraduation, RejectsFalseClosuresInSpaceAndKeepsTheTrueOnes) {
  Graph clean = helix_3d(80, 0.02), dirty = helix_3d(80, 0.02);
  const std::vector<EdgeId> wrong = make_false_closures<EdgeSE3>(clean, 0.2, 4).add(dirty);
  ASSERT_GT(wrong.size(), 15u);
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");
  ASSERT_TRUE(optimise(clean, {}, *solver).converged);
  guess_from_odometry(dirty);
  const GraduationResult result =
      optimise_graduated(dirty, options(), *solver, odometry_edges(dirty));
  EXPECT_TRUE(result.optimiser.converged) << result.optimiser.reason_text();
  EXPECT_EQ(result.rejected, static_cast<int>(wrong.size()));
  for (const EdgeId edge : wrong) EXPECT_LT(result.weight[edge.slot], 0.01);
  if (GetParam() == Graduation::kTruncated) {
    // Truncated least squares of which nothing true is truncated: the same optimum.
    EXPECT_LT(test::state_difference(clean, dirty), 1e-4);
  } else {
    EXPECT_LT(test::state_difference(clean, dirty), 0.05);
  }
}

TEST_P(EitherGraduation, WithoutOutliersChangesLittle) {
  Graph plain = ring_2d(40, 0.02), graduated = ring_2d(40, 0.02);
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");
  optimise(plain, {}, *solver);
  const GraduationResult result = optimise_graduated(graduated, options(), *solver);
  EXPECT_EQ(result.rejected, 0);
  EXPECT_LT(test::state_difference(plain, graduated),
            GetParam() == Graduation::kTruncated ? 1e-6 : 0.02);
}

TEST_P(EitherGraduation, PutsTheKernelsBack) {
  Graph graph = ring_2d(20);
  const RobustKernel own = RobustKernel::parse("cauchy:2");
  graph.set_kernel(own);
  optimise_graduated(graph, options(), *make_linear_solver("auto"));
  for (const EdgeSE2& edge : graph.edges_of<EdgeSE2>()) EXPECT_EQ(edge.kernel, own);
}

TEST_P(EitherGraduation, LeavesTrustedEdgesAlone) {
  Graph graph = ring_2d(20);
  EdgeSE2 outlier;
  outlier.measurement = SE2<double>(9.0, -3.0, 1.0);
  const EdgeId trusted = graph.add_edge(outlier, VertexId<VertexSE2>{3}, VertexId<VertexSE2>{11});
  const GraduationResult result = optimise_graduated(graph, options(), *make_linear_solver("auto"),
                                                     std::vector<int>{trusted.slot});
  EXPECT_EQ(result.weight[trusted.slot], 1.0);
}

TEST_P(EitherGraduation, BringsBackWhatIsDoubtedWithoutReason) {
  Graph all = helix_3d(80, 0.02), doubting = helix_3d(80, 0.02);
  const std::vector<EdgeId> wrong = make_false_closures<EdgeSE3>(all, 0.2, 4).add(doubting);
  guess_from_odometry(all);
  guess_from_odometry(doubting);
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");
  const std::vector<int> odometry = odometry_edges(doubting);
  optimise_graduated(all, options(), *solver, odometry_edges(all));
  std::vector<int> doubted;  // the wrong ones, and two in three of the others
  for (int slot = 0; slot < doubting.edge_slots(); ++slot) {
    const bool trusted = std::find(odometry.begin(), odometry.end(), slot) != odometry.end();
    if (!trusted && (slot >= wrong.front().slot || slot % 3 != 0)) doubted.push_back(slot);
  }
  ASSERT_GT(doubted.size(), wrong.size() + 20);
  const GraduationResult result =
      optimise_graduated(doubting, options(), *solver, odometry, doubted);
  EXPECT_TRUE(result.optimiser.converged) << result.optimiser.reason_text();
  EXPECT_EQ(result.rejected, static_cast<int>(wrong.size()));
  for (const EdgeId edge : wrong) EXPECT_EQ(result.weight[edge.slot], 0.0);
  EXPECT_LT(test::state_difference(all, doubting), 1e-4);
}

TEST(Graduation, SharesTheProbabilityOutAmongAllSuspectsWhenAskedTo) {
  Graph graph;
  const VertexId<VertexSE2> a = graph.add_vertex(0, VertexSE2());
  const VertexId<VertexSE2> b = graph.add_vertex(1, VertexSE2());
  graph.set_fixed(a, true);
  EdgeSE2 edge;
  edge.information *= 1e6;
  const EdgeId trusted = graph.add_edge(edge, a, b);
  edge.information = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 9; ++i) graph.add_edge(edge, a, b);
  // s = 15 lies between the quantiles of χ² at 0.99 (11.34) and at 1 − 0.01/10 (16.27).
  edge.measurement = SE2<double>(std::sqrt(15.0), 0.0, 0.0);
  graph.add_edge(edge, a, b);
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");
  GraduationOptions options;
  EXPECT_EQ(optimise_graduated(graph, options, *solver, std::vector<int>{trusted.slot}).rejected,
            1);
  options.for_all = true;
  EXPECT_EQ(optimise_graduated(graph, options, *solver, std::vector<int>{trusted.slot}).rejected,
            0);
}

TEST_P(EitherGraduation, EndsWithTheDeadline) {
  Graph graph = ring_2d(20);
  GraduationOptions late = options();
  late.optimiser.deadline = Deadline::after(0.0);
  const GraduationResult result = optimise_graduated(graph, late, *make_linear_solver("auto"));
  EXPECT_EQ(result.optimiser.reason, OptimiserResult::Reason::kDeadline);
  EXPECT_EQ(result.rounds, 1);
}

TEST(Graduation, OptionsOutOfRangeAreErrors) {
  const auto throws = [](auto&& change) {
    GraduationOptions options;
    change(options);
    EXPECT_THROW(options.validate(), Error);
  };
  throws([](GraduationOptions& o) { o.inlier_probability = 1.0; });
  throws([](GraduationOptions& o) { o.width = -1.0; });
  throws([](GraduationOptions& o) { o.factor = 1.0; });
  throws([](GraduationOptions& o) { o.max_rounds = 0; });
  throws([](GraduationOptions& o) { o.iterations_per_round = 0; });
  throws([](GraduationOptions& o) { o.optimiser.max_refusals = 0; });
}

TEST(Graduation, OdometryIsWhatIsNoLoopClosure) {
  Graph graph = ring_2d(10);  // edges i → i + 1, one back to the start, one chord
  const VertexId<VertexXY> seen_once = graph.add_vertex(100, VertexXY());
  const EdgeId landmark = graph.add_edge(EdgeSE2XY(), VertexId<VertexSE2>{2}, seen_once);
  const EdgeId prior = graph.add_edge(EdgePriorSE2(), VertexId<VertexSE2>{5});
  const std::vector<int> found = odometry_edges(graph);
  EXPECT_EQ(found, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, landmark.slot, prior.slot}));
}

/// Real measurements: every tenth loop closure of a public file is false.
class TenPercentFalse : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(PoseGraphFiles, TenPercentFalse, testing::Values("intel", "CSAIL"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(TenPercentFalse, LoopClosuresAreSurvived) {
  const std::filesystem::path file = std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "pose_graphs" /
                                     (std::string(GetParam()) + ".g2o");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");
  Graph clean = read_graph(file, standard_types());
  clean.set_fixed(0, true);
  optimise(clean, {}, *solver);
  const FalseClosures<EdgeSE2> wrong = make_false_closures<EdgeSE2>(clean, 0.1, 1);
  Graph graph = read_graph(file, standard_types());
  graph.set_fixed(0, true);
  const std::vector<EdgeId> added = wrong.add(graph);
  guess_from_odometry(graph);
  const GraduationResult result = optimise_graduated(graph, {}, *solver, odometry_edges(graph));
  EXPECT_TRUE(result.optimiser.converged) << result.optimiser.reason_text();
  EXPECT_EQ(result.rejected, static_cast<int>(added.size()));
  for (const EdgeId edge : added) EXPECT_EQ(result.weight[edge.slot], 0.0);
  EXPECT_LT(test::state_difference(clean, graph), 1e-2);
}

TEST_P(TenPercentFalse, LoopClosuresAreSurvivedBySwitchingConstraints) {
  const std::filesystem::path file = std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "pose_graphs" /
                                     (std::string(GetParam()) + ".g2o");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");
  Graph clean = read_graph(file, standard_types());
  clean.set_fixed(0, true);
  optimise(clean, {}, *solver);
  Graph graph = read_graph(file, standard_types());
  graph.set_fixed(0, true);
  make_false_closures<EdgeSE2>(clean, 0.1, 1).add(graph);
  guess_from_odometry(graph);
  graph.set_kernel(RobustKernel::parse("dcs:1"));
  for (const int slot : odometry_edges(graph)) {
    const Graph::EdgeRecord& record = graph.edge_record(slot);
    graph.edge_pools()[record.pool]->kernel(record.index) = RobustKernel();
  }
  EXPECT_TRUE(optimise(graph, {}, *solver).converged);
  EXPECT_LT(test::state_difference(clean, graph), 0.5);
}

}  // namespace
}  // namespace locograph
