#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/cost_of.h"
#include "core/toy_graphs.h"

namespace locograph::test {
namespace {

using Reason = OptimiserResult::Reason;

TEST(Optimiser, AllAlgorithmsAndSolversReachTheSameOptimum) {
  for (const auto& build : {std::function<Graph()>([] { return ring_2d(30); }),
                            std::function<Graph()>([] { return helix_3d(30); })}) {
    std::vector<double> finals;
    for (const Algorithm algorithm : kAlgorithms) {
      for (const std::string& solver : linear_solver_names()) {
        Graph graph = build();
        OptimiserOptions options;
        options.algorithm = algorithm;
        options.gain = 1e-12;
        const OptimiserResult result = run(graph, options, solver);
        EXPECT_TRUE(result.converged) << name_of(algorithm) << ": " << result.reason_text();
        EXPECT_LT(result.final.chi2, 0.5 * result.initial.chi2);
        finals.push_back(result.final.chi2);
      }
    }
    for (const double chi2 : finals) EXPECT_NEAR(chi2, finals[0], 1e-9 * finals[0]);
  }
}

/// Vectors of the workspace lie at different distances from the boundaries of the cache.
TEST(Optimiser, GivesTheSameBitsWhereverItsMemoryLies) {
  for (const Algorithm algorithm : kAlgorithms) {
    std::vector<std::vector<double>> held, ends;
    for (int k = 0; k < 8; ++k) {
      Graph graph = helix_3d(30);
      Problem problem;
      problem.compile(graph);
      Workspace workspace;
      workspace.allocate(problem);
      workspace.load_state();
      const auto move = [&](std::vector<double>& values) {
        held.emplace_back(static_cast<std::size_t>(2 * k + 1));
        std::vector<double> elsewhere;
        elsewhere.reserve(values.capacity() + static_cast<std::size_t>(2 * k));
        elsewhere.assign(values.begin(), values.end());
        values.swap(elsewhere);
      };
      move(workspace.state());
      move(workspace.trial());
      move(workspace.step());
      move(workspace.damping());
      OptimiserOptions options;
      options.algorithm = algorithm;
      const std::unique_ptr<LinearSolver> solver = make_linear_solver("dense");
      Optimiser optimiser(options);
      optimiser.start(workspace, *solver);
      while (optimiser.iterate()) {
      }
      ends.push_back(workspace.state());
    }
    for (const std::vector<double>& end : ends) EXPECT_EQ(end, ends[0]) << name_of(algorithm);
  }
}

TEST(Optimiser, NamesTwoEliminatedVerticesThatShareAnEdge) {
  Graph graph = ring_2d(12);
  graph.set_eliminate(4, true);
  graph.set_eliminate(5, true);
  const std::string expected = "vertices " + std::to_string(graph.vertex_record(4).id) + " and " +
                               std::to_string(graph.vertex_record(5).id) + " are both";
  try {
    run(graph, {}, "schur");
    ADD_FAILURE() << "they were eliminated";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
  }
}

TEST(Optimiser, LeavesFixedVerticesBitForBit) {
  Graph graph = ring_2d(12);
  graph.set_fixed(4, true);
  const Eigen::Vector3d before = graph.vertex(VertexId<VertexSE2>{4}).state;
  run(graph, {});
  EXPECT_EQ(graph.vertex(VertexId<VertexSE2>{4}).state, before);
}

TEST(Optimiser, ReportsTheCostItReached) {
  Graph graph = ring_2d(12);
  graph.set_kernel(RobustKernel::parse("cauchy:0.3"));
  const OptimiserResult result = run(graph, {});
  const Cost cost = cost_of(graph);
  EXPECT_NEAR(cost.robust, result.final.robust, 1e-12 * cost.robust);
  EXPECT_NEAR(cost.chi2, result.final.chi2, 1e-12 * cost.chi2);
  EXPECT_LT(cost.robust, cost.chi2);
}

TEST(Optimiser, ARobustKernelHoldsOffAnOutlier) {
  const auto error_with = [](const std::string& kernel) {
    Graph graph = ring_2d(20, 1e-3);
    EdgeSE2 outlier;
    outlier.measurement = SE2<double>(50.0, -30.0, 2.0);
    outlier.information *= 10.0;
    graph.add_edge(outlier, VertexId<VertexSE2>{3}, VertexId<VertexSE2>{11});
    Graph truth = ring_2d(20, 0.0);
    graph.set_kernel(RobustKernel::parse(kernel));
    run(graph, {});
    double worst = 0.0;
    for (int i = 0; i < 20; ++i) {
      const VertexId<VertexSE2> v{i};
      worst = std::max(worst, (graph.vertex(v).state - truth.vertex(v).state).head<2>().norm());
    }
    return worst;
  };
  EXPECT_GT(error_with("none"), 1.0);
  EXPECT_LT(error_with("geman-mcclure:1"), 0.1);
  EXPECT_LT(error_with("cauchy:0.1"), 0.1);
}

class EveryAlgorithm : public testing::TestWithParam<Algorithm> {
 protected:
  OptimiserOptions options() const {
    OptimiserOptions options;
    options.algorithm = GetParam();
    return options;
  }
};
INSTANTIATE_TEST_SUITE_P(Optimiser, EveryAlgorithm, testing::ValuesIn(kAlgorithms),
                         [](const auto& info) { return name_of(info.param); });

TEST_P(EveryAlgorithm, StopsWhenTheGainIsSmall) {
  Graph graph = ring_2d(20);
  const OptimiserResult result = run(graph, options());
  EXPECT_EQ(result.reason, Reason::kGain) << result.reason_text();
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.singular_vertex, -1);
  EXPECT_EQ(result.statistics.back().cost, result.final.robust);
}

TEST_P(EveryAlgorithm, StopsWhereTheGradientVanishes) {
  Graph graph = ring_2d(20, 0.0);
  graph.vertex(VertexId<VertexSE2>{1}).state[0] += 1e-14;
  const OptimiserResult result = run(graph, options());
  EXPECT_EQ(result.reason, Reason::kGradient) << result.reason_text();
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.iterations, 0);
}

TEST_P(EveryAlgorithm, StopsWhenTheStepVanishes) {
  Graph graph = ring_2d(20);
  OptimiserOptions loose = options();
  loose.step_tolerance = 100.0;
  const OptimiserResult result = run(graph, loose);
  EXPECT_EQ(result.reason, Reason::kStep) << result.reason_text();
  EXPECT_TRUE(result.converged);
  EXPECT_LE(result.iterations, 1);
}

TEST_P(EveryAlgorithm, StopsWhenItsIterationsAreUsedUp) {
  Graph graph = ring_2d(20);
  OptimiserOptions few = options();
  few.max_iterations = 1;
  const OptimiserResult result = run(graph, few);
  EXPECT_EQ(result.reason, Reason::kMaxIterations) << result.reason_text();
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_LT(result.final.chi2, result.initial.chi2);
}

TEST_P(EveryAlgorithm, WithoutIterationsOnlyEvaluates) {
  Graph graph = ring_2d(20);
  OptimiserOptions none = options();
  none.max_iterations = 0;
  const OptimiserResult result = run(graph, none);
  EXPECT_EQ(result.reason, Reason::kMaxIterations);
  EXPECT_EQ(result.final.chi2, result.initial.chi2);
}

TEST_P(EveryAlgorithm, ThatMayRunForEverNeedsNoMemoryForIt) {
  Graph graph = ring_2d(20);
  OptimiserOptions many = options();
  many.max_iterations = std::numeric_limits<int>::max();
  EXPECT_TRUE(run(graph, many).converged);
}

TEST_P(EveryAlgorithm, StopsAtItsDeadline) {
  Graph graph = ring_2d(20);
  OptimiserOptions late = options();
  late.deadline = Deadline::after(-1.0);
  const OptimiserResult result = run(graph, late);
  EXPECT_EQ(result.reason, Reason::kDeadline) << result.reason_text();
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.iterations, 0);
}

TEST_P(EveryAlgorithm, RefusesAnInitialStateWhoseCostIsNotANumber) {
  Graph graph = ring_2d(5);
  graph.add_dynamic_edge(ToyMoments<Derivatives::kDual>(), {graph.add_vertex(50, VertexXY())});
  graph.add_edge(ToyNotANumber(), graph.find<VertexXY>(50));
  const OptimiserResult result = run(graph, options());
  EXPECT_EQ(result.reason, Reason::kNotFinite) << result.reason_text();
  EXPECT_FALSE(result.converged);
}

TEST_P(EveryAlgorithm, HasNothingToDoWhenEveryVertexIsFixed) {
  for (const std::string& solver : linear_solver_names()) {
    Graph graph = ring_2d(5);
    for (int v = 0; v < graph.vertex_slots(); ++v) graph.set_fixed(v, true);
    const OptimiserResult result = run(graph, options(), solver);
    EXPECT_EQ(result.reason, Reason::kNothingToDo) << result.reason_text();
    EXPECT_TRUE(result.converged);
    EXPECT_GT(result.final.chi2, 0.0);
  }
}

TEST(Optimiser, GaussNewtonNamesTheVertexThatNothingHolds) {
  for (const std::string& solver : linear_solver_names()) {
    Graph graph = ring_2d(40);
    const VertexId<VertexXY> loose = graph.add_vertex(99, VertexXY({1.0, 2.0}));
    OptimiserOptions options;
    options.algorithm = Algorithm::kGaussNewton;
    const OptimiserResult result = run(graph, options, solver);
    EXPECT_EQ(result.reason, Reason::kSingular) << result.reason_text();
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.singular_vertex, loose.slot) << solver;
  }
}

TEST(Optimiser, GaussNewtonSeesTheFreeGaugeOfAGraphWithoutFixedVertex) {
  // Whole numbers: the gauge is exactly singular, not only up to rounding.
  Graph graph;
  std::vector<VertexId<VertexXY>> points;
  for (int i = 0; i < 6; ++i) points.push_back(graph.add_vertex(i, VertexXY({2.0 * i, 0.0})));
  for (int i = 0; i + 1 < 6; ++i) graph.add_edge(EdgePointXY(), points[i], points[i + 1]);
  OptimiserOptions options;
  options.algorithm = Algorithm::kGaussNewton;
  const OptimiserResult result = run(graph, options, "dense");
  EXPECT_EQ(result.reason, Reason::kSingular) << result.reason_text();
  EXPECT_EQ(result.singular_vertex, points.back().slot);
}

TEST(Optimiser, DampingCopesWithAFreeGauge) {
  for (const Algorithm algorithm : {Algorithm::kLevenbergMarquardt, Algorithm::kDogleg}) {
    Graph held = ring_2d(30), loose = ring_2d(30);
    loose.set_fixed(0, false);
    loose.add_vertex(99, VertexXY({1.0, 2.0}));
    OptimiserOptions options;
    options.algorithm = algorithm;
    const double expected = run(held, options).final.chi2;
    const OptimiserResult result = run(loose, options);
    EXPECT_TRUE(result.converged) << name_of(algorithm) << ": " << result.reason_text();
    EXPECT_NEAR(result.final.chi2, expected, 1e-6 * expected) << name_of(algorithm);
    EXPECT_EQ(loose.vertex(loose.find<VertexXY>(99)).state, Eigen::Vector2d(1.0, 2.0));
  }
}

Graph arctan_graph() {
  Graph graph;
  graph.add_edge(ToyArctan(), graph.add_vertex(0, VertexXY({3.0, 0.0})));
  return graph;
}

TEST(Optimiser, GaussNewtonThatRaisesTheCostKeepsTheBetterState) {
  Graph graph = arctan_graph();
  OptimiserOptions options;
  options.algorithm = Algorithm::kGaussNewton;
  const OptimiserResult result = run(graph, options);
  EXPECT_EQ(result.reason, Reason::kDiverged) << result.reason_text();
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.final.chi2, result.initial.chi2);
  EXPECT_EQ(graph.vertex(VertexId<VertexXY>{0}).state, Eigen::Vector2d(3.0, 0.0));
}

TEST(Optimiser, DampedAlgorithmsConvergeWhereGaussNewtonDiverges) {
  for (const Algorithm algorithm : {Algorithm::kLevenbergMarquardt, Algorithm::kDogleg}) {
    Graph graph = arctan_graph();
    OptimiserOptions options;
    options.algorithm = algorithm;
    const OptimiserResult result = run(graph, options);
    EXPECT_TRUE(result.converged) << result.reason_text();
    EXPECT_LT(graph.vertex(VertexId<VertexXY>{0}).state.norm(), 1e-5) << name_of(algorithm);
    EXPECT_GT(result.statistics.front().refusals, 0) << name_of(algorithm);
  }
}

TEST(Optimiser, GivesUpWhenNoStepLowersTheCost) {
  for (const Algorithm algorithm : {Algorithm::kLevenbergMarquardt, Algorithm::kDogleg}) {
    Graph graph = arctan_graph();
    OptimiserOptions options;
    options.algorithm = algorithm;
    options.max_refusals = 1;
    const OptimiserResult result = run(graph, options);
    EXPECT_EQ(result.reason, Reason::kNoProgress) << result.reason_text();
    EXPECT_EQ(graph.vertex(VertexId<VertexXY>{0}).state, Eigen::Vector2d(3.0, 0.0));
  }
}

TEST(Optimiser, GoesOnAfterRefusalsAsIfItHadNotStopped) {
  Graph at_once = arctan_graph(), in_parts = arctan_graph();
  OptimiserOptions options;
  run(at_once, options);
  options.max_refusals = 1;
  Problem problem;
  problem.compile(in_parts);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  const auto solver = make_linear_solver("auto");
  Optimiser optimiser(options);
  optimiser.start(workspace, *solver);
  int refused = 0;
  for (int most = 0; most < 1000 && !optimiser.result().converged; ++most) {
    if (optimiser.iterate() || optimiser.result().reason != Reason::kNoProgress) continue;
    ++refused;
    optimiser.go_on_refused();
    EXPECT_TRUE(optimiser.is_linearised());
  }
  EXPECT_GT(refused, 0);
  workspace.store_state();
  EXPECT_EQ(in_parts.vertex(VertexId<VertexXY>{0}).state,
            at_once.vertex(VertexId<VertexXY>{0}).state);
}

TEST(Optimiser, MarquardtsScaledDampingReachesTheSameOptimum) {
  Graph plain = helix_3d(20), scaled = helix_3d(20);
  OptimiserOptions options;
  const double expected = run(plain, options).final.chi2;
  options.scale_by_diagonal = true;
  EXPECT_NEAR(run(scaled, options).final.chi2, expected, 1e-6 * expected);
}

TEST(Optimiser, EveryReasonHasItsText) {
  std::vector<std::string> texts;
  for (int reason = 0; reason <= static_cast<int>(Reason::kNothingToDo); ++reason) {
    OptimiserResult result;
    result.reason = static_cast<Reason>(reason);
    EXPECT_FALSE(result.reason_text().empty());
    texts.push_back(result.reason_text());
  }
  std::sort(texts.begin(), texts.end());
  EXPECT_EQ(std::unique(texts.begin(), texts.end()), texts.end());
}

TEST(OptimiserOptions, OutOfRangeAreErrorsThatNameTheOption) {
  const auto refused = [](const char* name, auto&& change) {
    OptimiserOptions options;
    change(options);
    try {
      options.validate();
      ADD_FAILURE() << name << " was accepted";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
    EXPECT_THROW(Optimiser{options}, Error);
  };
  const double nan = std::nan("");
  refused("max_iterations", [](OptimiserOptions& o) { o.max_iterations = -1; });
  refused("gain", [](OptimiserOptions& o) { o.gain = -1e-9; });
  refused("gain", [](OptimiserOptions& o) { o.gain = 1.0; });
  refused("gain", [&](OptimiserOptions& o) { o.gain = nan; });
  refused("gradient_tolerance", [](OptimiserOptions& o) { o.gradient_tolerance = -1.0; });
  refused("step_tolerance", [&](OptimiserOptions& o) { o.step_tolerance = nan; });
  refused("initial_lambda", [](OptimiserOptions& o) { o.initial_lambda = 0.0; });
  refused("initial_radius", [](OptimiserOptions& o) { o.initial_radius = -2.0; });
  refused("max_refusals", [](OptimiserOptions& o) { o.max_refusals = 0; });
  EXPECT_NO_THROW(OptimiserOptions().validate());
}

}  // namespace
}  // namespace locograph::test
