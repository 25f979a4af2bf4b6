#pragma once
/// The report of one cycle of the online planner: how good the window is that it handed out, and
/// where its time went.

#include <locograph/core/violations.h>
#include <locograph/planners/answer/planner_answer.h>

#include <optional>

namespace locograph {

/// Iterations are those of all runs of the optimiser.
struct WindowStatistics : PlannerStatistics {
  int constraints = 0;       ///< edges of the window that were looked at
  int rounds = 0;            ///< of the augmented Lagrangian
  double iteration_s = 0.0;  ///< the longest one
  double compile_s = 0.0, optimise_s = 0.0, proposals_s = 0.0, check_s = 0.0;
  double linearise_s = 0.0, solve_s = 0.0, evaluate_s = 0.0;  ///< parts of optimise_s
};

/// Solved: the whole window is feasible. A cycle does not put a failure into words, which would
/// allocate memory: LocalPlanner::explain() does.
struct CycleReport : PlannerAnswer {
  int executed = 0;
  int window = 0;              ///< configurations freed
  bool next_feasible = false;  ///< the configuration that is executed next, and the way to it
  int feasible_steps = 0;      ///< of the window, before the first violation
  /// The worst one of the first step that violates any, and the configuration that this leads to.
  std::optional<ConstraintViolation> violation;  ///< by explain()
  int violated_at = -1;                          ///< index in the plan
  bool detour = false;                           ///< proposals were asked
  bool deadline_missed = false;
  bool cut_short = false;  ///< the termination ended the cycle before its search was over
  WindowStatistics statistics;
};

}  // namespace locograph
