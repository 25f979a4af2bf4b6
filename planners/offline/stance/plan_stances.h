#pragma once
/// What all stance planners do: goal after goal is reached, the way there shortened and judged;
/// what the judge refuses is mended or forbidden, and the search goes on.
///
///     const StancePlan plan =
///         plan_stances(problem, options, [](StanceSpace& space, auto& options, StancePlan& plan) {
///           return [&](const Footing& goal, StancePath& path) { return search(space, goal, path);
///           };
///         });

#include <locograph/planners/offline/stance/stance_path.h>

#include <functional>
#include <memory>

namespace locograph {

/// Appends the way from the path's last footing to the goal; false: not found.
using ReachGoal = std::function<bool(const Footing& goal, StancePath& path)>;
using MakeSearch = std::function<ReachGoal(StanceSpace&, const StancePlannerOptions&, StancePlan&)>;

StancePlan plan_stances(const StanceProblem& problem, const StancePlannerOptions& options,
                        const MakeSearch& make_search);

/// The same by a class whose constructor takes what MakeSearch takes and whose `reach` is a
/// ReachGoal.
template <class Search>
StancePlan plan_with(const StanceProblem& problem, const StancePlannerOptions& options) {
  return plan_stances(
      problem, options, [](StanceSpace& space, const StancePlannerOptions& o, StancePlan& plan) {
        const auto search = std::make_shared<Search>(space, o, plan);
        return
            [search](const Footing& goal, StancePath& path) { return search->reach(goal, path); };
      });
}

/// Searches call it for each footing they come to: keeps in the plan the one that has most of the
/// goal's contacts.
void note_best(StancePlan& plan, const StanceSpace& space, const Footing& footing,
               const Footing& goal);

}  // namespace locograph
