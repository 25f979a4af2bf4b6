#pragma once
/// The rest of a drive, planned anew from where the robot has come to rest: something is in its
/// way, or it has ended beside its goal.
///
///     ResumedPlan resumed = resume_drive(stopped_graph, planned, task, world_now);
///     if (resumed.success()) graph = std::move(*resumed.graph);
///
/// The base goes to its goal along straight lines, from rest to rest, with its wheels steered
/// before each: the shortest way on a grid of 0.1 m, by A* (Hart, Nilsson & Raphael 1968), pulled
/// tight. First it drives back along its own way to where it leans over as at the goal, since
/// wheels are steered far about upright axes only; at the end it turns on the spot, as far as the
/// plan would have turned it. Height and legs stay as they are where it leaves its own way. Of
/// three distances from obstacles the largest one with which there is such a way that the judge
/// accepts.

#include <locograph/core/graph.h>
#include <locograph/planners/online/resumed_plan.h>
#include <locograph/planners/task/task.h>
#include <locograph/world/world_snapshot.h>

#include <memory>

namespace locograph {

/// stopped: ends at rest, on wheels that roll. planned: as it was before, not empty; it ends at the
/// goal, of which the place and heading of the base count. world: nothing moves in it. Throws Error
/// as plan_of() does.
ResumedPlan resume_drive(const Graph& stopped, const Motion& planned, const Task& task,
                         std::shared_ptr<const WorldSnapshot> world,
                         const Termination& termination = {});

}  // namespace locograph
