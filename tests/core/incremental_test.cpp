#include <gtest/gtest.h>
#include <locograph/core/optimiser.h>

#include "common/allocation_counter.h"
#include "core/toy_graphs.h"

namespace locograph::test {
namespace {

double chi2_of(Graph& graph) {
  OptimiserOptions exact;
  exact.gain = 1e-14;
  return run(graph, exact).final.chi2;
}

/// Copies a vertex and, when both ends are there, its edges.
class Replay {
 public:
  explicit Replay(const Graph& whole) : whole_(whole) {}
  void add(Graph& graph, int id) const {
    const VertexId<VertexSE2> pose = graph.add_vertex(id, whole_.vertex(VertexId<VertexSE2>{id}));
    if (id == 0) graph.set_fixed(pose, true);
    for (const EdgeSE2& edge : whole_.edges_of<EdgeSE2>()) {
      const int a = edge.vertices[0], b = edge.vertices[1];
      if (std::max(a, b) != id) continue;
      graph.add_edge(edge, graph.find<VertexSE2>(a), graph.find<VertexSE2>(b));
    }
  }

 private:
  const Graph& whole_;
};

TEST(IncrementalUse, GrowingAGraphPoseByPoseEndsAtTheBatchOptimum) {
  Graph whole = ring_2d(30);
  Graph grown;
  Problem problem;
  Workspace workspace;
  Optimiser optimiser(OptimiserOptions{});
  const auto solver = make_linear_solver("auto");
  for (int id = 0; id < 30; ++id) {
    Replay(whole).add(grown, id);
    problem.compile(grown);
    workspace.allocate(problem);
    workspace.load_state();
    optimiser.start(workspace, *solver);
    while (optimiser.iterate()) {
    }
    EXPECT_TRUE(optimiser.result().converged) << optimiser.result().reason_text();
    workspace.store_state();
  }
  EXPECT_NEAR(chi2_of(grown), chi2_of(whole), 1e-9);
}

TEST(IncrementalUse, RemovingVerticesAndEdgesEqualsNeverHavingAddedThem) {
  Graph graph = ring_2d(20), never = ring_2d(20);
  const double before = chi2_of(graph);
  // A wrong loop closure, and a pose of its own that hangs off the ring.
  EdgeSE2 wrong;
  wrong.measurement = SE2<double>(5.0, 5.0, 1.0);
  const EdgeId loop = graph.add_edge(wrong, VertexId<VertexSE2>{3}, VertexId<VertexSE2>{15});
  const auto extra = graph.add_vertex(100, VertexSE2());
  graph.add_edge(wrong, VertexId<VertexSE2>{7}, extra);
  graph.add_edge(wrong, VertexId<VertexSE2>{9}, extra);
  EXPECT_GT(chi2_of(graph), before + 1.0);
  graph.remove_edge(loop);
  graph.remove_vertex(extra.slot);
  EXPECT_EQ(graph.edge_count(), never.edge_count());
  EXPECT_NEAR(chi2_of(graph), before, 1e-9);
}

TEST(IncrementalUse, ChangedMeasurementsNeedNoAnalysisAndNoMemory) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  Graph graph = helix_3d(60);
  Problem problem;
  Workspace workspace;
  Optimiser optimiser(OptimiserOptions{});
  const auto solver = make_linear_solver("block-cholesky");
  const auto solve = [&] {
    problem.compile(graph);
    workspace.allocate(problem);
    workspace.load_state();
    optimiser.start(workspace, *solver);
    while (optimiser.iterate()) {
    }
    workspace.store_state();
  };
  solve();
  problem.compile(graph);
  workspace.allocate(problem);
  const long before = allocation_count();
  solver->analyse(problem.pattern());
  EXPECT_EQ(allocation_count() - before, 0) << "the same pattern: the analysis is kept";
  graph.edge<EdgeSE3>({4}).measurement = SE3<double>();
  solve();
  EXPECT_TRUE(optimiser.result().converged);
  // Warm: at the optimum there is nothing left to do.
  solve();
  EXPECT_LE(optimiser.result().iterations, 1);
}

TEST(IncrementalUse, AWindowReadsOnlyWhatTouchesIt) {
  Graph graph = ring_2d(200);
  Problem problem;
  problem.compile(graph, std::vector<int>{50, 51, 52});
  EXPECT_EQ(problem.edge_count(), 4);
  EXPECT_EQ(problem.dimension(), 9);
  Problem whole;
  whole.compile(graph);
  EXPECT_EQ(whole.edge_count(), 201);
}

}  // namespace
}  // namespace locograph::test
