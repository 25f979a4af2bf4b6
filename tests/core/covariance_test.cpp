#include <gtest/gtest.h>
#include <locograph/core/covariance.h>
#include <locograph/core/graph_file.h>
#include <locograph/types/standard_types.h>

#include <Eigen/Dense>
#include <type_traits>

#include "core/dense_system.h"
#include "core/toy_graphs.h"

namespace locograph::test {
namespace {

struct DenseInverse {
  explicit DenseInverse(Graph& graph) {
    problem.compile(graph);
    Workspace workspace;
    workspace.allocate(problem);
    workspace.load_state();
    workspace.evaluate(workspace.state());
    workspace.linearise();
    const Eigen::MatrixXd hessian = dense_hessian(workspace);
    inverse = hessian.ldlt().solve(Eigen::MatrixXd::Identity(hessian.rows(), hessian.cols()));
  }
  Eigen::MatrixXd block(int a, int b) const {
    int begin[2] = {}, size[2] = {};
    for (int row = 0; row < problem.pattern().size(); ++row) {
      for (const int i : {0, 1}) {
        if (problem.free_vertices()[row] != (i == 0 ? a : b)) continue;
        begin[i] = problem.pattern().scalar_begin[row];
        size[i] = problem.pattern().dimension[row];
      }
    }
    return inverse.block(begin[0], begin[1], size[0], size[1]);
  }
  Problem problem;
  Eigen::MatrixXd inverse;
};

class EverySolver : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Covariance, EverySolver,
                         testing::Values("dense", "banded", "block-cholesky", "auto"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST_P(EverySolver, GivesTheBlocksOfTheDenseInverse) {
  Graph graphs[] = {ring_2d(25), helix_3d(15)};
  for (Graph& graph : graphs) {
    graph.set_kernel(RobustKernel::parse("cauchy:1"));
    run(graph, {});
    const DenseInverse reference(graph);
    const Covariance covariance(graph, make_linear_solver(GetParam()));
    ASSERT_FALSE(covariance.singular()) << covariance.reason_text();
    const std::vector<std::pair<int, int>> pairs{{3, 3}, {7, 3}, {3, 7}, {1, 14}, {14, 14}};
    const std::vector<Eigen::MatrixXd> blocks = covariance.blocks(pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      EXPECT_LE(relative_difference(blocks[i], reference.block(pairs[i].first, pairs[i].second)),
                1e-10);
    }
    EXPECT_EQ(covariance.block(3, 3), blocks[0]);
  }
}

TEST(Covariance, OfSeveralVerticesIsOneSymmetricMatrix) {
  Graph graph = ring_2d(12);
  const Covariance covariance(graph, make_linear_solver("auto"));
  const std::vector<int> vertices{5, 2, 9};
  const Eigen::MatrixXd joint = covariance.joint(vertices);
  ASSERT_EQ(joint.rows(), 9);
  EXPECT_EQ(joint, joint.transpose());
  EXPECT_GT(joint.llt().matrixL().determinant(), 0.0);
  EXPECT_LE(relative_difference(joint.block(0, 3, 3, 3), covariance.block(5, 2)), 1e-14);
  EXPECT_LE(relative_difference(joint.block(6, 3, 3, 3), covariance.block(9, 2)), 1e-14);
}

TEST(Covariance, OfAChainGrowsByTheNoiseOfEachStep) {
  Graph graph;
  std::vector<VertexId<VertexXY>> ids;
  for (int i = 0; i < 6; ++i) {
    ids.push_back(graph.add_vertex(i, VertexXY({static_cast<double>(i), 0.0})));
    if (i == 0) continue;
    EdgePointXY edge;
    edge.measurement << 1.0, 0.0;
    edge.information = Eigen::Vector2d(4.0, 25.0).asDiagonal();
    graph.add_edge(edge, ids[i - 1], ids[i]);
  }
  graph.set_fixed(ids[0], true);
  const Covariance covariance(graph, make_linear_solver("auto"));
  EXPECT_NEAR(covariance.block(ids[5], ids[5])(0, 0), 5.0 / 4.0, 1e-12);
  EXPECT_NEAR(covariance.block(ids[5], ids[5])(1, 1), 5.0 / 25.0, 1e-12);
  EXPECT_NEAR(covariance.block(ids[2], ids[5])(0, 0), 2.0 / 4.0, 1e-12);
}

TEST(Covariance, SaysWhenThereIsNone) {
  Graph graph = ring_2d(25);
  graph.set_fixed(0, false);
  const Covariance covariance(graph, make_linear_solver("auto"));
  EXPECT_TRUE(covariance.singular());
  EXPECT_NE(covariance.reason_text().find("singular"), std::string::npos);
  EXPECT_THROW(covariance.block(1, 1), Error);
}

TEST(Covariance, IsNotTakenForSingularBecauseAChainIsLong) {
  // The condition of H grows with the fourth power of the length.
  for (const auto& [length, accuracy] : {std::pair(300, 1e-6), std::pair(3000, 1e-2)}) {
    Graph graph;
    std::vector<VertexId<VertexSE2>> ids;
    for (int i = 0; i <= length; ++i) {
      ids.push_back(graph.add_vertex(i, VertexSE2(SE2<double>(i, 0.0, 0.0))));
      if (i == 0) continue;
      EdgeSE2 edge;
      edge.measurement = SE2<double>(1.0, 0.0, 0.0);
      graph.add_edge(edge, ids[i - 1], ids[i]);
    }
    graph.set_fixed(ids[0], true);
    const Covariance covariance(graph, make_linear_solver("auto"));
    ASSERT_FALSE(covariance.singular());
    EXPECT_NEAR(covariance.block(ids[length], ids[length])(2, 2), length, accuracy * length);
  }
}

TEST(Covariance, RefusesVerticesThatHaveNone) {
  Graph graph = ring_2d(10);
  const Covariance covariance(graph, make_linear_solver("auto"));
  EXPECT_THROW(covariance.block(0, 1), Error) << "held fixed";
  EXPECT_THROW(covariance.block(1, 99), Error);
  EXPECT_THROW(covariance.block(-1, 1), Error);
}

/// Nothing that goes away with a statement may be handed over.
static_assert(!std::is_constructible_v<Covariance, Graph&, LinearSolver&>);

TEST(Covariance, OutlivesTheGraphAndWhoeverMadeTheSolver) {
  // pcg keeps pointers to the matrix it is to solve.
  for (const char* name : {"auto", "pcg", "schur"}) {
    const auto made = [name](Graph graph) { return Covariance(graph, make_linear_solver(name)); };
    Graph graph = ring_2d(12);
    Covariance first = made(ring_2d(12));
    const Covariance covariance = std::move(first);
    const Covariance expected(graph, make_linear_solver("dense"));
    EXPECT_LE(relative_difference(covariance.block(5, 2), expected.block(5, 2)), 1e-6) << name;
    EXPECT_EQ(covariance.joint(std::vector<int>{5, 2}).rows(), 6);
    EXPECT_THROW(covariance.block(0, 1), Error) << "held fixed";
  }
}

TEST(Covariance, NeedsASolver) {
  Graph graph = ring_2d(4);
  EXPECT_THROW(Covariance(graph, nullptr), Error);
}

TEST(Covariance, OfAPoseGraphFileIsTheDenseInverse) {
  const std::filesystem::path file =
      std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "pose_graphs" / "tinyGrid3D.g2o";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  Graph graph = read_graph(file, standard_types());
  graph.set_fixed(0, true);
  run(graph, {});
  const DenseInverse reference(graph);
  const Covariance covariance(graph, make_linear_solver("block-cholesky"));
  ASSERT_FALSE(covariance.singular());
  for (int v = 1; v < graph.vertex_slots(); ++v) {
    EXPECT_LE(relative_difference(covariance.block(v, 5), reference.block(v, 5)), 1e-9);
  }
}

}  // namespace
}  // namespace locograph::test
