#include <locograph/core/initial_guess.h>
#include <locograph/types/best_guess.h>
#include <locograph/types/chordal_guess.h>

#include <cmath>
#include <vector>

namespace locograph {
namespace {

/// Of the cost over the number of rows: above it values are poor.
constexpr double kPoorCost = 10.0;

/// The best values so far, of which the graph and the workspace hold another guess now and then.
class Comparison {
 public:
  Comparison(Workspace& workspace, bool use_present) : workspace_(workspace) {
    workspace_.load_state();
    values_ = workspace_.state();
    if (!use_present) return;
    best_.cost = cost();
    found_ = true;
  }

  template <class Guess>
  void consider(const char* name, Guess guess) {
    const int unreached = guess();
    workspace_.load_state();
    if (found_ && workspace_.state() == values_) return;
    const double guessed = cost();
    if (found_ && !(guessed < best_.cost) && std::isfinite(best_.cost)) {
      workspace_.state() = values_;
      workspace_.store_state();
      return;
    }
    best_ = {name, guessed, unreached};
    values_ = workspace_.state();
    found_ = true;
  }

  bool poor() const {
    return !(best_.cost <= kPoorCost * static_cast<double>(workspace_.problem().residual_count()));
  }

  BestGuess take() {
    workspace_.load_state();
    return best_;
  }

 private:
  double cost() { return workspace_.evaluate(workspace_.state()).robust; }

  Workspace& workspace_;
  BestGuess best_;
  bool found_ = false;
  std::vector<double> values_;
};

}  // namespace

BestGuess take_best_guess(Workspace& workspace, LinearSolver& solver,
                          const BestGuessOptions& options) {
  Graph& graph = workspace.problem().graph();
  Comparison comparison(workspace, options.use_present);
  comparison.consider("odometry", [&] { return guess_from_odometry(graph); });
  comparison.consider("spanning-tree", [&] { return guess_from_spanning_tree(graph); });
  if (comparison.poor()) {
    comparison.consider("chordal", [&] { return guess_chordal(graph, solver, options.left_out); });
  }
  return comparison.take();
}

}  // namespace locograph
