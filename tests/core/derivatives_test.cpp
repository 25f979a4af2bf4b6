#include <gtest/gtest.h>
#include <locograph/core/typed_edge_pool.h>
#include <locograph/types/slam3d/edges.h>

#include <random>

#include "core/dense_system.h"
#include "core/toy_types.h"

namespace locograph::test {
namespace {

constexpr Derivatives kByHand = Derivatives::kByHand, kDual = Derivatives::kDual,
                      kNumeric = Derivatives::kNumeric;

class Numbers {
 public:
  explicit Numbers(unsigned seed) : engine_(seed) {}
  double operator()() { return distribution_(engine_); }
  Eigen::VectorXd vector(int n) {
    return Eigen::VectorXd::NullaryExpr(n, [this](Eigen::Index) { return (*this)(); });
  }
  Eigen::MatrixXd information(int n) {
    const Eigen::MatrixXd a =
        Eigen::MatrixXd::NullaryExpr(n, n, [this](Eigen::Index) { return (*this)(); });
    return a * a.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
  }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> distribution_{-2.0, 2.0};
};

/// Points, planar poses and edges of run-time and fixed arity on them, in both orders of the
/// vertices, with fixed vertices and robust kernels.
template <Derivatives D>
Graph planar_graph(unsigned seed) {
  Numbers number(seed);
  Graph graph;
  std::vector<VertexId<VertexSE2>> poses;
  std::vector<VertexId<VertexXY>> points;
  // Interleaved, so that for some edges the pose comes first in H and for some the point.
  for (int i = 0; i < 6; ++i) {
    points.push_back(graph.add_vertex(i, VertexXY(number.vector(2))));
    poses.push_back(graph.add_vertex(10 + i, VertexSE2(SE2<double>(number(), number(), number()))));
  }
  for (int i = 0; i < 6; ++i) {
    points.push_back(graph.add_vertex(20 + i, VertexXY(number.vector(2))));
  }
  const char* kernels[] = {"none", "huber:0.5", "cauchy:1:second-order", "tukey:3", "dcs:2"};
  int next = 0;
  const auto dress = [&](auto& edge, int dimension) {
    edge.information = number.information(dimension);
    edge.measurement = number.vector(dimension);
    edge.kernel = RobustKernel::parse(kernels[next++ % 5]);
  };
  for (std::size_t a = 0; a < poses.size(); ++a) {
    for (const std::size_t p : {a, (a + 3) % 12, (a + 7) % 12}) {
      ToyRange<D> range;
      dress(range, 2);
      graph.add_edge(range, poses[a], points[p]);
    }
  }
  for (int count = 1; count <= 5; ++count) {
    std::vector<VertexId<VertexXY>> some;
    for (int i = 0; i < count; ++i) some.push_back(points[(7 * i + 5 * count) % 12]);
    ToyMoments<D> moments;
    dress(moments, 2);
    graph.add_dynamic_edge(moments, some);
    ToyView<D> view;
    dress(view, 3);
    graph.add_dynamic_edge(view, some, poses[count]);
  }
  graph.set_fixed(poses[2], true);
  graph.set_fixed(points[5], true);
  graph.set_fixed(points[7], true);
  return graph;
}

/// Arms of different numbers of joints, derived quantities, binary and n-ary.
template <Derivatives D>
Graph arms_graph(unsigned seed) {
  Numbers number(seed);
  Graph graph;
  std::vector<VertexId<VertexJoints>> arms;
  std::vector<VertexId<VertexXY>> points;
  for (int i = 0; i < 6; ++i) {
    points.push_back(graph.add_vertex(i, VertexXY(number.vector(2))));
    arms.push_back(graph.add_vertex(10 + i, VertexJoints(number.vector(2 + i % 3))));
  }
  for (int i = 0; i < 6; ++i) {
    ToyReach<D> reach;
    reach.information = number.information(2);
    graph.add_edge(reach, arms[i], points[(i + 2) % 6]);
    ToyMeet<D> meet;
    meet.information = number.information(2);
    meet.kernel = RobustKernel::parse("cauchy:2:second-order");
    graph.add_edge(meet, arms[(i + 1) % 6], arms[i]);
    ToyCarry<D> carry;
    carry.information = number.information(2);
    std::vector<VertexId<VertexJoints>> others;
    for (int j = 1; j <= 1 + i % 4; ++j) others.push_back(arms[(i + j) % 6]);
    graph.add_dynamic_edge(carry, others, arms[i]);
  }
  graph.set_fixed(arms[3], true);
  graph.set_fixed(points[1], true);
  return graph;
}

/// Error sizes known at run time.
Graph run_time_sized_graph(unsigned seed) {
  Numbers number(seed);
  Graph graph;
  std::vector<VertexId<VertexXY>> points;
  for (int i = 0; i < 5; ++i) points.push_back(graph.add_vertex(i, VertexXY(number.vector(2))));
  for (int n = 1; n <= 7; ++n) {
    ToySignal signal;
    signal.measurement = number.vector(n);
    signal.information = number.information(n);
    graph.add_dynamic_edge(signal, {points[n % 5], points[(n + 2) % 5], points[(n + 4) % 5]});
  }
  for (int i = 0; i < 4; ++i) {
    const VertexId<VertexJoints> arm =
        graph.add_vertex(10 + i, VertexJoints(number.vector(1 + 2 * i)));
    ToyPosture posture;
    posture.measurement = number.vector(1 + 2 * i);
    posture.information = number.information(1 + 2 * i);
    graph.add_edge(posture, arm);
  }
  graph.set_fixed(points[3], true);
  return graph;
}

struct Compiled {
  explicit Compiled(Graph g) : graph(std::move(g)) {
    problem.compile(graph);
    workspace.allocate(problem);
    workspace.load_state();
    evaluated = workspace.evaluate(workspace.state());
    linearised = workspace.linearise();
  }
  Graph graph;
  Problem problem;
  Workspace workspace;
  Cost evaluated, linearised;
};

void expect_same_system(Compiled& a, Compiled& b, double tolerance) {
  EXPECT_EQ(a.problem.pattern(), b.problem.pattern());
  EXPECT_LE(relative_difference(dense_hessian(a.workspace), dense_hessian(b.workspace)), tolerance);
  EXPECT_LE(relative_difference(dense_gradient(a.workspace), dense_gradient(b.workspace)),
            tolerance);
  EXPECT_NEAR(a.linearised.robust, b.linearised.robust, 1e-12 * a.linearised.robust);
}

/// Jacobians as used against central differences, edge by edge and slot by slot.
void expect_jacobians_equal_differences(Compiled& c) {
  StateEvaluation evaluation(c.problem, c.workspace.state());
  const Evaluation x = evaluation.get();
  int compared = 0;
  for (std::size_t p = 0; p < c.problem.edges().size(); ++p) {
    const EdgePool& pool = *c.graph.edge_pools()[p];
    const CompiledEdges& edges = c.problem.edges()[p];
    for (int k = 0; k < static_cast<int>(edges.edges.size()); ++k) {
      const int count = edges.slot_begin[k + 1] - edges.slot_begin[k];
      for (int slot = 0; slot < count; ++slot) {
        const Eigen::MatrixXd used = pool.jacobian(edges, k, slot, x, false);
        const Eigen::MatrixXd differences = pool.jacobian(edges, k, slot, x, true);
        EXPECT_LE(relative_difference(used, differences), 1e-8)
            << pool.tag() << " edge " << k << " slot " << slot << "\n"
            << used << "\n\n"
            << differences;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 0);
}

class EverySeed : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Derivatives, EverySeed, testing::Values(1u, 2u, 3u));

TEST_P(EverySeed, HandWrittenDualAndNumericDerivativesAgree) {
  Compiled hand(planar_graph<kByHand>(GetParam()));
  Compiled dual(planar_graph<kDual>(GetParam()));
  Compiled numeric(planar_graph<kNumeric>(GetParam()));
  expect_same_system(hand, dual, 1e-13);
  expect_same_system(hand, numeric, 1e-8);
}

TEST_P(EverySeed, DerivedQuantitiesGiveTheSameDerivativesByHandAndNumerically) {
  Compiled hand(arms_graph<kByHand>(GetParam()));
  Compiled numeric(arms_graph<kNumeric>(GetParam()));
  expect_same_system(hand, numeric, 1e-8);
}

TEST_P(EverySeed, JacobiansEqualDifferences) {
  Compiled hand(planar_graph<kByHand>(GetParam())), dual(planar_graph<kDual>(GetParam())),
      arms(arms_graph<kByHand>(GetParam()));
  expect_jacobians_equal_differences(hand);
  expect_jacobians_equal_differences(dual);
  expect_jacobians_equal_differences(arms);
}

TEST_P(EverySeed, BatchEqualsEdgesOneByOne) {
  Compiled hand(planar_graph<kByHand>(GetParam())), dual(planar_graph<kDual>(GetParam())),
      numeric(planar_graph<kNumeric>(GetParam()));
  EXPECT_GT(expect_batch_equals_one_by_one(hand.workspace, 1e-13).hessian.norm(), 0.1);
  EXPECT_GT(expect_batch_equals_one_by_one(dual.workspace, 1e-13).hessian.norm(), 0.1);
  EXPECT_GT(expect_batch_equals_one_by_one(numeric.workspace, 1e-13).hessian.norm(), 0.1);
}

TEST_P(EverySeed, BatchEqualsEdgesOneByOneWithDerivedQuantities) {
  Compiled hand(arms_graph<kByHand>(GetParam())), numeric(arms_graph<kNumeric>(GetParam()));
  EXPECT_GT(expect_batch_equals_one_by_one(hand.workspace, 1e-13).hessian.norm(), 0.1);
  EXPECT_GT(expect_batch_equals_one_by_one(numeric.workspace, 1e-13).hessian.norm(), 0.1);
}

TEST_P(EverySeed, BatchEqualsEdgesOneByOneWithSizesKnownAtRunTime) {
  Compiled sized(run_time_sized_graph(GetParam()));
  EXPECT_GT(expect_batch_equals_one_by_one(sized.workspace, 1e-13).hessian.norm(), 0.1);
}

TEST(Derivatives, DifferencesOfKnownFunctionsAreRight) {
  // Error 0 of the moments is Σ wᵢ |pᵢ|²: its derivative by p₁ is 2 w₁ p₁ᵀ, worked out here.
  Compiled numeric([] {
    Graph graph;
    const auto a = graph.add_vertex(0, VertexXY({1.5, -0.5}));
    const auto b = graph.add_vertex(1, VertexXY({0.25, 3.0}));
    graph.add_dynamic_edge(ToyMoments<kNumeric>(), {a, b});
    return graph;
  }());
  StateEvaluation evaluation(numeric.problem, numeric.workspace.state());
  const Eigen::MatrixXd j = numeric.graph.edge_pools()[0]->jacobian(numeric.problem.edges()[0], 0,
                                                                    1, evaluation.get(), false);
  Eigen::Matrix2d expected;
  expected << 4.0 * 0.25, 4.0 * 3.0, 2.0 * std::sin(3.0), 2.0 * 0.25 * std::cos(3.0);
  EXPECT_LE(relative_difference(j, expected), 1e-9);
}

TEST(Derivatives, AKernelThatSilencesAnEdgeLeavesItOutOfTheSystem) {
  Compiled silent([] {
    Graph graph;
    const auto a = graph.add_vertex(0, VertexXY({5.0, 0.0}));
    ToyMoments<kByHand> edge;
    edge.kernel = RobustKernel::parse("saturated:1");
    graph.add_dynamic_edge(edge, {a});
    return graph;
  }());
  EXPECT_EQ(dense_hessian(silent.workspace).norm(), 0.0);
  EXPECT_EQ(dense_gradient(silent.workspace).norm(), 0.0);
  EXPECT_EQ(silent.linearised.robust, 1.0);
  EXPECT_EQ(silent.linearised.chi2, 625.0);
}

TEST(Derivatives, OfManyVerticesNeedNoMoreScratchMemoryThanWasReserved) {
  // 60 vertices of one edge: the numeric path copies all states, the dual path all views.
  const auto build = []<Derivatives D>(std::integral_constant<Derivatives, D>) {
    Numbers number(5);
    Graph graph;
    std::vector<VertexId<VertexXY>> points;
    for (int i = 0; i < 60; ++i) points.push_back(graph.add_vertex(i, VertexXY(number.vector(2))));
    const auto pose = graph.add_vertex(100, VertexSE2(SE2<double>(0.1, 0.2, 0.3)));
    graph.add_dynamic_edge(ToyView<D>(), points, pose);
    return graph;
  };
  Compiled hand(build(std::integral_constant<Derivatives, kByHand>())),
      dual(build(std::integral_constant<Derivatives, kDual>())),
      numeric(build(std::integral_constant<Derivatives, kNumeric>()));
  expect_same_system(hand, dual, 1e-13);
  expect_same_system(hand, numeric, 1e-7);
}

}  // namespace
}  // namespace locograph::test
