#include <gtest/gtest.h>
#include <locograph/core/diagnosis.h>
#include <locograph/core/optimiser.h>
#include <locograph/core/typed_edge_pool.h>

#include <algorithm>
#include <limits>
#include <random>

#include "core/cost_of.h"
#include "core/toy_graphs.h"

namespace locograph::test {

/// Error (2): the point, whose Jacobian has the wrong sign.
struct ToyWrongSign : Edge<2, VertexXY> {
  template <class T>
  void error(const Eigen::Matrix<T, 2, 1>& p, Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    e = p;
  }
  void jacobians(const Eigen::Vector2d&, JacobianRef<ToyWrongSign, 0> j) const {
    j = -Eigen::Matrix2d::Identity();
  }
};
LOCOGRAPH_REGISTER_EDGE("TOY_WRONG_SIGN", ToyWrongSign)

/// Error (2) of Rosenbrock's valley: 10 (y − x²) and 1 − x.
struct ToyValley : Edge<2, VertexXY> {
  template <class T>
  void error(const Eigen::Matrix<T, 2, 1>& p, Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    e << T(10.0) * (p[1] - p[0] * p[0]), T(1.0) - p[0];
  }
};
LOCOGRAPH_REGISTER_EDGE("TOY_VALLEY", ToyValley)

namespace {

using Reason = OptimiserResult::Reason;

Graph valley(double x, double y) {
  Graph graph;
  graph.add_edge(ToyValley(), graph.add_vertex(0, VertexXY({x, y})));
  return graph;
}

/// A ring whose poses are anywhere.
Graph scattered_ring(unsigned seed) {
  Graph graph = ring_2d(30);
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  for (int v = 1; v < 30; ++v) {
    for (double& value : graph.vertex(VertexId<VertexSE2>{v}).state) value += normal(engine);
  }
  return graph;
}

TEST(ReferenceCost, WithoutRisesIsThePresentCost) {
  ReferenceCost reference;
  reference.start(10.0, 0);
  EXPECT_EQ(reference.quality(8.0, 4.0), 0.5);
  reference.accept(8.0, 4.0);
  EXPECT_LT(reference.quality(9.0, 1.0), 0.0);
}

TEST(ReferenceCost, LetsTheCostRiseBelowTheReference) {
  ReferenceCost reference;
  reference.start(10.0, 2);
  reference.accept(8.0, 2.0);
  EXPECT_EQ(reference.quality(9.0, 2.0), 0.25) << "10 to 9, of the 4 that were predicted since";
  EXPECT_LT(reference.quality(11.0, 2.0), 0.0);
}

TEST(ReferenceCost, FallsToTheHighestCostSinceTheLeastAfterAllRises) {
  ReferenceCost reference;
  reference.start(10.0, 2);
  reference.accept(5.0, 5.0);
  reference.accept(7.0, 1.0);
  reference.accept(6.0, 2.0);
  EXPECT_LT(reference.quality(8.0, 1.0), 0.0) << "no longer measured from 10";
  EXPECT_EQ(reference.quality(6.5, 1.0), 0.5 / 3.0) << "from 7, of the 3 predicted since";
}

TEST(PoorStart, ReachesTheOptimumOfGoodStarts) {
  Graph graphs[] = {ring_2d(30), helix_3d(30)};
  for (Graph& graph : graphs) {
    Graph same = graph.vertices_of<VertexSE2>().empty() ? helix_3d(30) : ring_2d(30);
    const double expected = run(same, {}).final.robust;
    const OptimiserResult result = run(graph, OptimiserOptions::for_any_start());
    EXPECT_TRUE(result.converged) << result.reason_text();
    EXPECT_NEAR(result.final.robust, expected, 1e-6 * expected);
  }
}

TEST(PoorStart, FollowsABentValleyToItsEnd) {
  for (const double x : {-1.2, -3.0, 4.0}) {
    Graph graph = valley(x, 1.0);
    const OptimiserResult result = run(graph, OptimiserOptions::for_any_start());
    EXPECT_LT(result.final.robust, 1e-12) << "from " << x << ": " << result.reason_text();
  }
}

TEST(PoorStart, EndsAtTheBestStateThatItHasSeen) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Graph graph = scattered_ring(seed);
    double least = std::numeric_limits<double>::infinity();
    OptimiserOptions options = OptimiserOptions::for_any_start();
    options.nonmonotonic_steps = 5;
    options.max_iterations = static_cast<int>(3 + seed);
    options.on_iteration = [&](const OptimiserResult& result) {
      least = std::min(least, result.final.robust);
      return true;
    };
    const OptimiserResult result = run(graph, options);
    EXPECT_LE(result.final.robust, std::min(least, result.initial.robust));
    // What the graph holds is what the result says.
    EXPECT_EQ(cost_of(graph).robust, result.final.robust);
  }
}

TEST(PoorStart, NonmonotonicDoglegEndsAtItsBestToo) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    Graph graph = scattered_ring(seed);
    OptimiserOptions options;
    options.algorithm = Algorithm::kDogleg;
    options.nonmonotonic_steps = 5;
    const OptimiserResult result = run(graph, options);
    EXPECT_EQ(cost_of(graph).robust, result.final.robust);
    EXPECT_LT(result.final.robust, result.initial.robust);
  }
}

TEST(PoorStart, StepsThatAreAllRefusedAreNoConvergence) {
  for (const Algorithm algorithm : {Algorithm::kLevenbergMarquardt, Algorithm::kDogleg}) {
    for (const bool any : {false, true}) {
      Graph graph;
      graph.add_edge(ToyWrongSign(), graph.add_vertex(0, VertexXY({3.0, 4.0})));
      OptimiserOptions options = any ? OptimiserOptions::for_any_start() : OptimiserOptions();
      options.algorithm = algorithm;
      const OptimiserResult result = run(graph, options);
      EXPECT_EQ(result.reason, Reason::kNoProgress) << result.reason_text();
      EXPECT_FALSE(result.converged);
      EXPECT_EQ(result.iterations, 0);
      EXPECT_NEAR(result.promised_decrease, 1.0, 1e-3);
      EXPECT_NE(result.reason_text().find("Jacobian"), std::string::npos);
    }
  }
}

TEST(PoorStart, DiagnosisNamesTheEdgeWhoseJacobianIsWrong) {
  Graph graph = ring_2d(5);
  const VertexId<VertexXY> point = graph.add_vertex(50, VertexXY({3.0, 4.0}));
  graph.add_edge(ToyWrongSign(), point);
  const Diagnosis diagnosis = diagnose(graph);
  EXPECT_FALSE(diagnosis.healthy());
  ASSERT_EQ(diagnosis.jacobians.size(), 1u);
  EXPECT_EQ(edge_text(graph, diagnosis.jacobians[0].edge), "TOY_WRONG_SIGN 50");
  EXPECT_NEAR(diagnosis.jacobians[0].difference, 2.0, 1e-6);
  EXPECT_NE(diagnosis.text(graph).find("the Jacobian of TOY_WRONG_SIGN 50 by its vertex 50"),
            std::string::npos)
      << diagnosis.text(graph);
}

TEST(PoorStart, DiagnosisFindsNothingWrongWithRightJacobians) {
  Graph graph = mixed_graph<Derivatives::kByHand>();
  EXPECT_TRUE(diagnose(graph).jacobians.empty()) << diagnose(graph).text(graph);
}

}  // namespace
}  // namespace locograph::test
