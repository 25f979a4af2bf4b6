#pragma once
/// Finds how a robot gets from one stance to others: a sequence of stances, one contact more or
/// less from each to the next, and a configuration for each change that is feasible for both.
///
///     const Task task = started_task(scenario).task;
///     const auto planner = make_stance_planner("guided");         // stance_planners.h
///     const StancePlan plan = planner->plan(task, {.seed = 7});
///     if (!plan.success()) std::cerr << plan.reason;
///
/// The first offline stage of Rossini et al., "Loco-Manipulation Planning for Legged Robots:
/// Offline and Online Strategies", whose S_σ and S_q it gives. Planners are chosen by name
/// (stance_planners.h).
///
/// What is found is judged (check/judge.h): success means judged feasible. Deterministic for a seed
/// but for the deadline, whatever the number of threads.

#include <locograph/planners/offline/stance/stance_search.h>

#include <memory>
#include <string>

namespace locograph {

class StancePlanner {
 public:
  virtual ~StancePlanner() = default;
  virtual const std::string& name() const = 0;
  /// A search that hands out one way after the other. The task must outlive it. Throws Error for
  /// options out of range, for stances that are not sound, and for a goal contact of an unknown end
  /// effector.
  virtual std::unique_ptr<StanceSearch> begin(const Task& task,
                                              const StancePlannerOptions& options) const = 0;
  /// The first way to each goal. Throws Error as begin() does.
  StancePlan plan(const Task& task, const StancePlannerOptions& options) const;
};

}  // namespace locograph
