#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/dense_system.h"
#include "core/toy_graphs.h"

namespace locograph::test {
namespace {

/// Large enough to be divided into chunks, with chords that join far chunks.
Graph large_helix() {
  Graph graph = helix_3d(400);
  std::mt19937 engine(5);
  std::uniform_int_distribution<int> any(0, 399);
  for (int i = 0; i < 100; ++i) {
    const int a = any(engine), b = any(engine);
    if (a == b) continue;
    EdgeSE3 edge;
    const VertexId<VertexSE3> from = graph.find<VertexSE3>(a), to = graph.find<VertexSE3>(b);
    edge.measurement = VertexSE3::view(graph.vertex(from).state.data()).inverse() *
                       VertexSE3::view(graph.vertex(to).state.data());
    edge.kernel = RobustKernel(RobustKernel::Kind::kHuber, 1.0);
    graph.add_edge(edge, from, to);
  }
  return graph;
}

struct NumbersOnThreads {
  std::vector<double> hessian, gradient;
  Cost evaluated, linearised;
};

NumbersOnThreads numbers(Graph& graph, ThreadPool* threads) {
  Problem problem;
  problem.compile(graph);
  EXPECT_GT(problem.chunks(), 1);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.use_threads(threads);
  workspace.load_state();
  NumbersOnThreads result;
  result.evaluated = workspace.evaluate(workspace.state());
  result.linearised = workspace.linearise();
  result.hessian.assign(workspace.hessian().begin(), workspace.hessian().end());
  result.gradient.assign(workspace.gradient().begin(), workspace.gradient().end());
  return result;
}

TEST(Chunks, SumUpToTheWholeSystem) {
  Graph graph = large_helix();
  Problem problem;
  problem.compile(graph);
  ASSERT_GT(problem.chunks(), 1);
  EXPECT_FALSE(problem.hessian_reductions().all.empty());
  int edges = 0;
  for (const CompiledEdges& compiled : problem.edges()) {
    ASSERT_TRUE(std::ranges::is_sorted(compiled.chunk_begin));
    std::vector<int> sorted = compiled.edges;
    std::ranges::sort(sorted);
    for (std::size_t k = 0; k < sorted.size(); ++k) EXPECT_EQ(sorted[k], static_cast<int>(k));
    edges += compiled.chunk_begin.back();
  }
  EXPECT_EQ(edges, graph.edge_count());
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  workspace.evaluate(workspace.state());
  workspace.linearise();
  const DenseSystem expected = one_by_one(problem, workspace.state());
  EXPECT_LE(relative_difference(dense_hessian(workspace), expected.hessian), 1e-13);
  EXPECT_LE(relative_difference(dense_gradient(workspace), expected.gradient), 1e-13);
}

TEST(Chunks, GiveTheSameBitsOnAnyNumberOfThreads) {
  Graph graph = large_helix();
  const NumbersOnThreads alone = numbers(graph, nullptr);
  for (const int size : {1, 2, 3}) {
    ThreadPool threads(size);
    const NumbersOnThreads shared = numbers(graph, &threads);
    EXPECT_TRUE(shared.hessian == alone.hessian) << size;
    EXPECT_TRUE(shared.gradient == alone.gradient) << size;
    EXPECT_EQ(shared.evaluated.chi2, alone.evaluated.chi2);
    EXPECT_EQ(shared.evaluated.robust, alone.evaluated.robust);
    EXPECT_EQ(shared.linearised.robust, alone.linearised.robust);
  }
}

TEST(Chunks, LeaveTheOptimumTheSameToTheBit) {
  std::vector<double> alone;
  for (const int size : {0, 2, 3}) {
    Graph graph = large_helix();
    std::unique_ptr<ThreadPool> threads = size > 0 ? std::make_unique<ThreadPool>(size) : nullptr;
    const OptimiserResult result = optimise(graph, {}, *make_linear_solver("auto"), threads.get());
    EXPECT_TRUE(result.converged) << result.reason_text();
    std::vector<double> states;
    for (int v = 0; v < graph.vertex_slots(); ++v) {
      states.insert(states.end(), graph.state(v), graph.state(v) + graph.state_size(v));
    }
    if (size == 0) {
      alone = states;
    } else {
      EXPECT_TRUE(states == alone) << size;
    }
  }
}

}  // namespace
}  // namespace locograph::test
