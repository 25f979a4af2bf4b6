#pragma once
/// The world around a plan as the local planner is shown it.
///
///     const WorldDistance seen = seen_world(graph, plan, judging.world);

#include <locograph/planners/plan/plan.h>
#include <locograph/world/distance_view.h>

namespace locograph {

/// Exact obstacles, and the distance field of the map as far from the plan as it matters.
WorldDistance seen_world(const Graph& graph, const Plan& plan, const World& world);

}  // namespace locograph
