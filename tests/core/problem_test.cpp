#include <gtest/gtest.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/slam2d/edges.h>

#include <random>

#include "common/allocation_counter.h"
#include "core/dense_system.h"
#include "core/toy_types.h"

namespace locograph::test {
namespace {

/// A chain of poses, each tied to the next two; every third sees a point of its own.
struct Chain {
  Graph graph;
  std::vector<int> poses;

  explicit Chain(int length) {
    std::mt19937 engine(4);
    std::normal_distribution<double> noise(0.0, 0.1);
    std::vector<VertexId<VertexSE2>> ids;
    for (int i = 0; i < length; ++i) {
      ids.push_back(graph.add_vertex(
          i, VertexSE2(SE2<double>(i + noise(engine), noise(engine), noise(engine)))));
      poses.push_back(ids.back().slot);
      for (const int back : {1, 2}) {
        if (i < back) continue;
        EdgeSE2 edge;
        edge.measurement = SE2<double>(back + noise(engine), noise(engine), noise(engine));
        edge.information *= 2.0 + noise(engine);
        // Half of the edges run backwards, so that their Hessian block is the transpose.
        if (i % 2 == 0) {
          graph.add_edge(edge, ids[i - back], ids[i]);
        } else {
          graph.add_edge(edge, ids[i], ids[i - back]);
        }
      }
    }
  }
  std::span<const int> window(int begin, int size) const {
    return std::span<const int>(poses).subspan(begin, size);
  }
};

void linearise(Problem& problem, Workspace& workspace) {
  workspace.allocate(problem);
  workspace.load_state();
  workspace.evaluate(workspace.state());
  workspace.linearise();
}

TEST(Problem, CompilesAllVerticesThatAreNotFixed) {
  Chain chain(6);
  chain.graph.set_fixed(chain.poses[2], true);
  Problem problem;
  problem.compile(chain.graph);
  EXPECT_EQ(problem.dimension(), 15);
  EXPECT_EQ(problem.state_size(), 18);
  EXPECT_EQ(problem.edge_count(), 9);
  EXPECT_EQ(problem.residual_count(), 27);
  EXPECT_TRUE(std::ranges::equal(problem.free_vertices(), std::vector<int>{0, 1, 3, 4, 5}));
  // Blocks (r, c), r ≤ c: the diagonal, and pairs at most two poses apart.
  const BlockPattern& p = problem.pattern();
  EXPECT_EQ(p.row, (std::vector<int>{0, 0, 1, 1, 2, 2, 3, 2, 3, 4}));
  EXPECT_EQ(p.column_begin, (std::vector<int>{0, 1, 3, 5, 7, 10}));
}

TEST(Problem, OfAWindowHasTheBlocksOfTheWholeGraph) {
  Chain chain(40);
  Problem whole, part;
  Workspace whole_numbers, part_numbers;
  whole.compile(chain.graph);
  linearise(whole, whole_numbers);
  const Eigen::MatrixXd all = dense_hessian(whole_numbers);
  const Eigen::VectorXd all_gradient = dense_gradient(whole_numbers);
  for (const int begin : {0, 7, 29}) {
    part.compile(chain.graph, chain.window(begin, 11));
    linearise(part, part_numbers);
    ASSERT_EQ(part.dimension(), 33);
    EXPECT_EQ(dense_hessian(part_numbers), all.block(3 * begin, 3 * begin, 33, 33)) << begin;
    EXPECT_EQ(dense_gradient(part_numbers), all_gradient.segment(3 * begin, 33)) << begin;
  }
}

TEST(Problem, OfAWindowTakesOnlyTheEdgesOnIt) {
  Chain chain(40);
  Problem problem;
  problem.compile(chain.graph, chain.window(10, 5));
  // 4 + 3 inside, and on either side 1 + 2 to the outside.
  EXPECT_EQ(problem.edge_count(), 13);
  EXPECT_EQ(problem.state_size(), 3 * (5 + 4));
}

TEST(Problem, OfAWindowInAnotherOrderIsThePermutedSystem) {
  Chain chain(12);
  const std::vector<int> order{chain.poses[5], chain.poses[3], chain.poses[4]};
  Problem problem, sorted;
  Workspace workspace, sorted_workspace;
  problem.compile(chain.graph, order);
  linearise(problem, workspace);
  sorted.compile(chain.graph, chain.window(3, 3));
  linearise(sorted, sorted_workspace);
  const Eigen::MatrixXd h = dense_hessian(workspace), s = dense_hessian(sorted_workspace);
  const int place[] = {2, 0, 1};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_LE(relative_difference(h.block(3 * i, 3 * j, 3, 3),
                                    s.block(3 * place[i], 3 * place[j], 3, 3)),
                1e-14);
    }
  }
}

TEST(Problem, OfASlidingWindowKeepsItsPatternAndTheSolverItsAnalysis) {
  Chain chain(40);
  Problem problem;
  problem.compile(chain.graph, chain.window(2, 10));
  const BlockPattern first = problem.pattern();
  std::vector<std::unique_ptr<LinearSolver>> solvers;
  for (const std::string& name : linear_solver_names()) {
    solvers.push_back(make_linear_solver(name));
    solvers.back()->analyse(first);
  }
  for (int begin = 3; begin < 28; ++begin) {
    problem.compile(chain.graph, chain.window(begin, 10));
    ASSERT_EQ(problem.pattern(), first) << begin;
    for (const std::unique_ptr<LinearSolver>& solver : solvers) {
      const long before = allocation_count();
      solver->analyse(problem.pattern());
      EXPECT_EQ(allocation_count(), before) << solver->name();
    }
  }
}

TEST(Workspace, OfASlidingWindowDoesNotAllocateOnceItHasItsMemory) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  Chain chain(60);
  Problem problem;
  Workspace workspace;
  for (int begin = 2; begin < 40; ++begin) {
    problem.compile(chain.graph, chain.window(begin, 10));
    const long before = allocation_count();
    workspace.allocate(problem);
    workspace.load_state();
    workspace.evaluate(workspace.state());
    workspace.linearise();
    if (begin > 2) {
      EXPECT_EQ(allocation_count(), before) << begin;
    }
  }
}

TEST(Problem, IgnoresFixedAndRepeatedVerticesOfAWindow) {
  Chain chain(12);
  chain.graph.set_fixed(chain.poses[4], true);
  const std::vector<int> window{3, 4, 5, 3};
  Problem problem;
  problem.compile(chain.graph, window);
  EXPECT_TRUE(std::ranges::equal(problem.free_vertices(), std::vector<int>{3, 5}));
}

TEST(Problem, IsCompiledAgainAfterTheGraphChanged) {
  Chain chain(8);
  Problem problem;
  Workspace workspace;
  problem.compile(chain.graph);
  linearise(problem, workspace);
  chain.graph.remove_vertex(chain.poses[3]);
  const auto point = chain.graph.add_vertex(100, VertexXY({1.0, 1.0}));
  chain.graph.add_edge(EdgeSE2XY(), VertexId<VertexSE2>{chain.poses[5]}, point);
  problem.compile(chain.graph);
  linearise(problem, workspace);
  EXPECT_EQ(problem.dimension(), 7 * 3 + 2);
  const DenseSystem reference = one_by_one(problem, workspace.state());
  EXPECT_LE(relative_difference(dense_hessian(workspace), reference.hessian), 1e-13);
}

TEST(Problem, AndItsWorkspaceServeOneGraphAfterAnother) {
  // The pools of the second graph hold other types in other places.
  Graph first, second;
  const auto arm = first.add_vertex(0, VertexJoints(Eigen::Vector3d(0.1, 0.2, 0.3)));
  const auto target = first.add_vertex(1, VertexXY({1.0, 1.0}));
  first.add_edge(ToyReach<Derivatives::kByHand>(), arm, target);
  const auto long_arm = second.add_vertex(0, VertexJoints(Eigen::VectorXd::Constant(9, 0.1)));
  const auto other = second.add_vertex(1, VertexXY({2.0, 1.0}));
  second.add_edge(ToyReach<Derivatives::kByHand>(), long_arm, other);
  Problem problem;
  Workspace workspace;
  for (Graph* graph : {&first, &second, &first}) {
    problem.compile(*graph);
    linearise(problem, workspace);
    const DenseSystem reference = one_by_one(problem, workspace.state());
    EXPECT_LE(relative_difference(dense_hessian(workspace), reference.hessian), 1e-13);
  }
}

TEST(Workspace, GivesDiagonalAndQuadraticFormOfH) {
  Chain chain(9);
  chain.graph.set_fixed(chain.poses[0], true);
  Problem problem;
  Workspace workspace;
  problem.compile(chain.graph);
  linearise(problem, workspace);
  const Eigen::MatrixXd h = dense_hessian(workspace);
  std::vector<double> diagonal(problem.dimension()), x(problem.dimension());
  workspace.diagonal(diagonal);
  for (int i = 0; i < problem.dimension(); ++i) {
    EXPECT_EQ(diagonal[i], h(i, i));
    x[i] = std::sin(1.0 + i);
  }
  const Eigen::Map<Eigen::VectorXd> v(x.data(), problem.dimension());
  EXPECT_NEAR(workspace.quadratic_form(x), v.dot(h * v), 1e-12 * h.norm() * v.squaredNorm());
}

TEST(Workspace, StepsOnlyFreeVerticesAndStoresOnlyThem) {
  Chain chain(3);
  chain.graph.set_fixed(chain.poses[1], true);
  const Eigen::Vector3d held = chain.graph.vertex(VertexId<VertexSE2>{1}).state;
  const Eigen::Vector3d free = chain.graph.vertex(VertexId<VertexSE2>{2}).state;
  Problem problem;
  Workspace workspace;
  problem.compile(chain.graph);
  workspace.allocate(problem);
  workspace.load_state();
  std::fill(workspace.step().begin(), workspace.step().end(), 0.25);
  workspace.apply_step();
  workspace.accept_trial();
  workspace.store_state();
  EXPECT_EQ(chain.graph.vertex(VertexId<VertexSE2>{1}).state, held);
  EXPECT_LE(
      (chain.graph.vertex(VertexId<VertexSE2>{2}).state - free - Eigen::Vector3d::Constant(0.25))
          .norm(),
      1e-15);
}

}  // namespace
}  // namespace locograph::test
