#pragma once
/// The rest of a drive, from where the robot has come to rest, once what moves has gone by.
///
///     ResumedPlan waited = wait_for_free_drive(stopped_graph, planned, task, world);
///     if (waited.success()) graph = std::move(*waited.graph);

#include <locograph/planners/online/resumed_plan.h>
#include <locograph/planners/task/task.h>
#include <locograph/world/world_snapshot.h>

#include <memory>

namespace locograph {

/// The rest of a drive, whose motion is given as it was before `stopped` ended: begun as soon as
/// nothing that moves, appears or vanishes is in its way, within kWaits_s of
/// changing_obstacles.h. Where the robot is beside its plan it is led back to it within 1.5 m of
/// its way, each wheel steered along its own way, before it moves. What else is in the way the next
/// windows have to pass: it is not judged. Not where nothing in the world changes, nor where the
/// robot is too far from its plan for that. Throws Error as plan_of() does.
ResumedPlan wait_for_free_drive(const Graph& stopped, const Motion& planned, const Task& task,
                                std::shared_ptr<const WorldSnapshot> world);

}  // namespace locograph
