#pragma once
/// The world around a plan as the local planner is shown it.
///
///     planner.show(seen_world(graph, plan, judging.world->world()));

#include <locograph/planners/plan/plan.h>
#include <locograph/world/world_snapshot.h>

#include <memory>

namespace locograph {

/// Its distance() has exact obstacles, and the distance field of the map as far from the plan as it
/// matters.
std::shared_ptr<const WorldSnapshot> seen_world(const Graph& graph, const Plan& plan,
                                                const World& world);

}  // namespace locograph
