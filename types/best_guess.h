#pragma once
/// The best of the first values that a graph can start from: those it has, odometry, a spanning
/// tree, and where these are poor the chordal guess.
///
///     problem.compile(graph);
///     workspace.allocate(problem);
///     BestGuess start = take_best_guess(workspace, *make_linear_solver("auto"));
///     std::cout << "starts from " << start.taken << '\n';
///
/// Compared is the cost Σ ρ(eᵀΩe). Values are poor when it is more than ten times the number of
/// rows of the errors: about one a row is what noise as Ω says leaves at the optimum. The chordal
/// guess takes two sparse solves, the others a walk along the edges and an evaluation each.

#include <locograph/core/linear_solver.h>
#include <locograph/core/workspace.h>

#include <span>
#include <string>

namespace locograph {

struct BestGuess {
  std::string taken = "none";  ///< or odometry, spanning-tree, chordal
  double cost = 0.0;
  int unreached = 0;  ///< vertices that no edge predicts: they kept their values
};

struct BestGuessOptions {
  /// The values that the graph has count; otherwise they are only where the walks start.
  bool use_present = true;
  /// Slots of edges that the chordal guess does without.
  std::span<const int> left_out = {};
};

/// The workspace is that of the whole graph. Graph and workspace hold the values taken; `solver`
/// must be analysed again.
BestGuess take_best_guess(Workspace& workspace, LinearSolver& solver,
                          const BestGuessOptions& options = {});

}  // namespace locograph
