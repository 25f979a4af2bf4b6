#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "core/toy_graphs.h"

namespace locograph::test {
namespace {

OptimiserResult solve(Graph graph, const std::string& kernel) {
  graph.set_kernel(RobustKernel::parse(kernel));
  OptimiserOptions options;
  options.gain = 1e-12;
  return run(graph, options);
}

/// Where many errors lie on the shoulder of a kernel that is convex in the error, weights alone
/// converge linearly.
TEST(SecondOrderKernel, ReachesTheSameOptimumInFewerIterations) {
  const std::pair<Graph (*)(int, double), const char*> cases[] = {{ring_2d, "pseudo-huber:0.1"},
                                                                  {helix_3d, "pseudo-huber:0.1"}};
  for (const auto& [make, kernel] : cases) {
    const OptimiserResult first = solve(make(40, 0.05), kernel);
    const OptimiserResult second = solve(make(40, 0.05), std::string(kernel) + ":second-order");
    EXPECT_TRUE(first.converged) << first.reason_text();
    EXPECT_TRUE(second.converged) << second.reason_text();
    EXPECT_NEAR(second.final.robust, first.final.robust, 1e-9 * first.final.robust);
    EXPECT_LT(2 * second.iterations, first.iterations);
  }
}

TEST(SecondOrderKernel, ChangesNothingWhereTheKernelDoesNotBite) {
  const OptimiserResult first = solve(ring_2d(40, 1e-3), "huber:1");
  const OptimiserResult second = solve(ring_2d(40, 1e-3), "huber:1:second-order");
  EXPECT_EQ(first.iterations, second.iterations);
  EXPECT_EQ(first.final.robust, second.final.robust);
}

TEST(SecondOrderKernel, NeverMakesTheHessianIndefinite) {
  for (const char* kernel : {"huber:0.1", "cauchy:0.1", "geman-mcclure:0.1", "welsch:0.3",
                             "tukey:1", "dcs:0.1", "arctan:0.3", "barron:0.1:-4"}) {
    Graph graph = ring_2d(20, 0.3);
    graph.set_kernel(RobustKernel::parse(std::string(kernel) + ":second-order"));
    Problem problem;
    problem.compile(graph);
    Workspace workspace;
    workspace.allocate(problem);
    workspace.load_state();
    workspace.evaluate(workspace.state());
    workspace.linearise();
    const BlockPattern& pattern = problem.pattern();
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(problem.dimension(), problem.dimension());
    for (int c = 0; c < pattern.size(); ++c) {
      for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
        const Eigen::Map<const Eigen::Matrix3d> block(workspace.hessian().data() +
                                                      pattern.value_offset[k]);
        h.block<3, 3>(3 * pattern.row[k], 3 * c) = block;
        h.block<3, 3>(3 * c, 3 * pattern.row[k]) = block.transpose();
      }
    }
    const Eigen::VectorXd eigenvalues = h.selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_GE(eigenvalues.minCoeff(), -1e-10 * eigenvalues.maxCoeff()) << kernel;
  }
}

}  // namespace
}  // namespace locograph::test
