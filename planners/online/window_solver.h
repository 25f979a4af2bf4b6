#pragma once
/// Optimises the window of an online planner on one compiled problem.
///
///     WindowSolver solver{WindowSolverOptions()};
///     solver.compile(window);
///     solver.load_state();
///     solver.optimise(WindowSolver::Start::kIncumbent, incumbent, termination, statistics);
///     const bool feasible = incumbent.best().quality.feasible();
///     if (!feasible) solver.raise_constraints(incumbent, termination, statistics);
///     solver.store_state(incumbent.best().state);
///
/// A run takes a few Levenberg-Marquardt steps from the state that was loaded, and offers its first
/// and its last state to the incumbent. Constraints that are still violated after it are raised by
/// the augmented Lagrangian of core; its multipliers are kept by edge from cycle to cycle, and so
/// is the damping λ.
///
/// The structure of the compiled problem is kept while the window slides. A run ends at most one
/// iteration after the termination asks for it.

#include <locograph/core/augmented_lagrangian.h>
#include <locograph/planners/online/cycle_report.h>
#include <locograph/planners/online/incumbent.h>
#include <locograph/planners/online/window.h>

#include <memory>
#include <vector>

namespace locograph {

struct WindowSolverOptions {
  int max_iterations = 15;  ///< of one optimisation
  int max_rounds = 3;       ///< of the augmented Lagrangian, after the first optimisation; 0: off
  double raise = 10.0;      ///< growth of a penalty from round to round
  double max_raise = 1e4;   ///< to which they grow, in all cycles together
  double gain = 1e-3;       ///< see OptimiserOptions
  double feasible_gain = 0.03;  ///< of one iteration that ends in a feasible window: enough

  void validate() const;
};

class WindowSolver {
 public:
  /// The window that a run starts from: the one that the last cycle handed out, or one beside it.
  /// Each has a damping of its own.
  enum class Start { kIncumbent, kCandidate };
  struct Run {
    bool better = false;     ///< one of its states is the incumbent's best now
    bool cut_short = false;  ///< by the termination
  };

  explicit WindowSolver(const WindowSolverOptions& options);
  ~WindowSolver();

  /// Once a cycle. The first iteration after it is begun whatever the deadline.
  void compile(const Window& window);
  void load_state() { workspace_.load_state(); }       ///< graph → state()
  void store_state(const std::vector<double>& state);  ///< → state() → graph
  const std::vector<double>& state() { return workspace_.state(); }
  const Problem& problem() const { return problem_; }

  /// Evaluates the state and offers it as it is.
  void offer_state(Incumbent& incumbent);
  /// Adds to the iterations and seconds, as does raise_constraints().
  Run optimise(Start start, Incumbent& incumbent, const Termination& termination,
               WindowStatistics& statistics);
  /// Optimises again from the least violating window, however early it was seen.
  Run raise_constraints(Incumbent& incumbent, const Termination& termination,
                        WindowStatistics& statistics);
  /// One iteration from the state, so that memory and the order of elimination are there.
  void prepare();

  ConstraintViolation describe(const ConstraintReader::Row& row) const {
    return reader_.describe(row);
  }

 private:
  struct Multiplier;

  void restore_multipliers();
  void keep_multipliers();
  WindowQuality quality(double cost) const;
  bool gained_little() const;
  bool good_enough() const;
  void learn(double& lambda);
  void add_statistics(WindowStatistics& statistics) const;

  WindowSolverOptions options_;
  Problem problem_;
  Workspace workspace_;
  ConstraintReader reader_;
  std::unique_ptr<LinearSolver> linear_solver_;
  Optimiser optimiser_;
  std::vector<double> diagonal_;
  /// With which runs begin, in units of the largest diagonal entry.
  double incumbent_lambda_, candidate_lambda_;
  bool first_iteration_ = true;          ///< since compile()
  std::vector<int> step_of_;             ///< of the constraints, see window_quality()
  int steps_ = 0;                        ///< of the window
  std::vector<Multiplier> multipliers_;  ///< by edge slot, ascending
};

}  // namespace locograph
