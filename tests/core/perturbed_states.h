#pragma once
/// Runs the augmented Lagrangian from many states that differ by no more than rounding does between
/// processors and compilers.
///
///     optimise_from_perturbed_states(graph, {}, [&](const ConstrainedResult& result,
///                                                   const std::vector<double>& state) {
///       EXPECT_NEAR(result.cost.chi2, 9.0, 1e-6);
///     });

#include <gtest/gtest.h>
#include <locograph/core/augmented_lagrangian.h>
#include <locograph/solvers/linear_solvers.h>

#include <random>
#include <vector>

#include "common/sanitized.h"

namespace locograph::test {

/// The state of the graph itself comes first. Stops at the first that does not converge.
template <class Check>
void optimise_from_perturbed_states(Graph& graph, const ConstrainedOptions& options, Check check) {
  constexpr int kStates = kSanitized ? 4 : 100;
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> little(-1e-12, 1e-12);
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  const auto solver = make_linear_solver("auto");
  for (int i = 0; i < kStates; ++i) {
    SCOPED_TRACE("state " + std::to_string(i));
    workspace.load_state();
    if (i > 0) {
      for (double& x : workspace.step()) x = little(random);
      workspace.apply_step();
      workspace.accept_trial();
    }
    const ConstrainedResult result = optimise_constrained(workspace, options, *solver);
    ASSERT_TRUE(result.converged) << result.reason_text(graph);
    check(result, workspace.state());
  }
}

}  // namespace locograph::test
