#pragma once
/// The error of a graph file's first edge, at the states of the file, against numbers known.
///
///     expect_error("VERTEX_XY 0 3 4\nEDGE_PRIOR_XY 0 1 1 1 0 1\n", {2.0, 3.0}, 1e-12);

#include <gtest/gtest.h>
#include <locograph/core/graph_file.h>
#include <locograph/types/standard_types.h>

#include <string>
#include <vector>

#include "core/dense_system.h"

namespace locograph::test {

inline void expect_error(const std::string& text, const std::vector<double>& expected,
                         double tolerance) {
  Graph graph = read_graph_text(text, "text.g2o", {}, standard_types());
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  StateEvaluation evaluation(problem, workspace.state());
  const EdgePool& pool = *graph.edge_pools()[0];
  ASSERT_EQ(pool.dimension(0), static_cast<int>(expected.size()));
  Eigen::VectorXd error(pool.dimension(0));
  pool.error(problem.edges()[0], 0, evaluation.get(), error.data());
  for (Eigen::Index i = 0; i < error.size(); ++i) {
    EXPECT_NEAR(error[i], expected[static_cast<std::size_t>(i)], tolerance) << "row " << i;
  }
}

}  // namespace locograph::test
