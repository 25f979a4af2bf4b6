#pragma once
/// The rest of a drive, planned anew from where the robot has come to rest: something is in its
/// way, or it has ended beside its goal.
///
///     ResumedPlan resumed = resume_drive(stopped_graph, planned, task, world_now);
///     if (resumed.success()) graph = std::move(*resumed.graph);
///
/// The base goes to its goal along straight lines, from rest to rest, with its wheels steered
/// before each: the shortest way on a grid of 0.1 m, by A* (Hart, Nilsson & Raphael 1968), pulled
/// tight. The robot keeps its heading until it turns, and its legs until they go to those of the
/// goal, both by the share of the way that it has gone. Of three distances from obstacles the
/// largest one with which there is such a way that the judge accepts.

#include <locograph/core/graph.h>
#include <locograph/planners/online/resumed_plan.h>
#include <locograph/planners/task/task.h>
#include <locograph/world/world_snapshot.h>

#include <memory>

namespace locograph {

/// stopped: ends at rest, on wheels that roll. planned: ends at the goal; of that the place and
/// heading of the base count, and the joints that are neither wheels nor steer them. world: nothing
/// moves in it. Throws Error as plan_of() does.
ResumedPlan resume_drive(const Graph& stopped, const Motion& planned, const Task& task,
                         std::shared_ptr<const WorldSnapshot> world,
                         const Termination& termination = {});

}  // namespace locograph
