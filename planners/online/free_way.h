#pragma once
/// The rest of a plan as it was planned, from where the robot has come to rest, once what was in
/// its way has gone by.
///
///     ResumedPlan waited = wait_for_free_way(stopped_graph, planned, segments, task, world);
///     if (waited.success()) graph = std::move(*waited.graph);

#include <locograph/core/graph.h>
#include <locograph/planners/online/resumed_plan.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/task/task.h>
#include <locograph/world/world_snapshot.h>

#include <memory>
#include <vector>

namespace locograph {

/// The rest of a plan, whose motion and segments are given as they were before `stopped` ended:
/// begun as soon as nothing that moves, appears or vanishes is in its way, within kWaits_s of
/// changing_obstacles.h. It begins slowly, as a robot brakes. Not where the robot has left the
/// planned way, nor where nothing in the world changes. Throws Error as plan_of() does.
ResumedPlan wait_for_free_way(const Graph& stopped, const Motion& planned,
                              const std::vector<PlanSegment>& segments, const Task& task,
                              std::shared_ptr<const WorldSnapshot> world);

}  // namespace locograph
