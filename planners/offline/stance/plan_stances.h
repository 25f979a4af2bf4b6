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

namespace locograph {

/// Appends the way from the path's last footing to the goal; false: not found.
using ReachGoal = std::function<bool(const Footing& goal, StancePath& path)>;
using MakeSearch = std::function<ReachGoal(StanceSpace&, const StancePlannerOptions&, StancePlan&)>;

StancePlan plan_stances(const StanceProblem& problem, const StancePlannerOptions& options,
                        const MakeSearch& make_search);

}  // namespace locograph
