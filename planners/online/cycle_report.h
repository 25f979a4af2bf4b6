#pragma once
/// The report of one cycle of the online planner: how good the window is that it handed out, and
/// where its time went.

#include <locograph/core/violations.h>

#include <optional>

namespace locograph {

struct CycleReport {
  int executed = 0;
  int window = 0;              ///< configurations freed
  bool feasible = false;       ///< the whole window
  bool next_feasible = false;  ///< the configuration that is executed next, and the way to it
  int feasible_steps = 0;      ///< of the window, before the first violation
  /// The worst one of the first step that violates any, and the configuration that this leads to.
  std::optional<ConstraintViolation> violation;
  int violated_at = -1;  ///< index in the plan
  int constraints = 0;   ///< edges of the window that were looked at
  int iterations = 0;
  int rounds = 0;       ///< of the augmented Lagrangian
  bool detour = false;  ///< proposals were asked
  bool deadline_missed = false;
  /// Seconds: the cycle, its longest iteration, and its phases.
  double time_total = 0.0, time_iteration = 0.0, time_compile = 0.0, time_optimise = 0.0;
  double time_detour = 0.0, time_check = 0.0, time_linearise = 0.0, time_solve = 0.0;
  double time_evaluate = 0.0;
};

}  // namespace locograph
