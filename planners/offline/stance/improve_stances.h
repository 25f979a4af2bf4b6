#pragma once
/// Uses the time that is left: plans again with other seeds and keeps the best.
///
///     options.termination.deadline = Deadline::after(5.0);
///     StancePlan plan = planner->plan(task, options);
///     const int better = improve_stances(*planner, task, options, 2, plan);

#include <locograph/planners/offline/stance/stance_planner.h>

namespace locograph {

/// Until the deadline or the stop flag, each seed on one of `threads`, whatever the options say; a
/// count is that of each plan. The best plan has the fewest stances; of as many, the one whose
/// joints move least from configuration to configuration (sum of the angles). Statistics are those
/// of all plans together. Returns how often a better one was found. Throws Error where neither
/// deadline nor stop flag is given. A plan without success is left alone.
int improve_stances(const StancePlanner& planner, const Task& task,
                    const StancePlannerOptions& options, int threads, StancePlan& plan);

}  // namespace locograph
