#pragma once
/// What part of the execution margin a plan has where it is given: at its start and its goals.
///
///     for (const GivenMargin& given : given_margins(task, plan)) {
///       std::cout << given.where << ": " << given.share << " of the margin\n";
///     }

#include <locograph/planners/offline/stance/stance_plan.h>
#include <locograph/planners/task/task.h>

#include <string>
#include <vector>

namespace locograph {

struct GivenMargin {
  std::string where;  ///< "start", "goal 1", …
  double share = 0.0;
  /// Of friction, area and least force that share of the task's, the rest as the task's.
  ExecutionMargin margin;
};

/// Of the start and of each goal that is reached, in the posture of the plan; none where the task
/// has no margin.
std::vector<GivenMargin> given_margins(const Task& task, const StancePlan& plan);

}  // namespace locograph
