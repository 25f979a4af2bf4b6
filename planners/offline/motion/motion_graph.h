#pragma once
/// A whole motion as a graph: what `locograph plan` writes.
///
///     Graph graph = motion_graph(task, plan);
///     write_graph(graph, "plan.g2o");
///
/// One VERTEX_CONFIGURATION for each configuration with its time and the stance that it is left in,
/// the first one fixed; VERTEX_WRENCHES where wrenches are known; a PARAMS_SEGMENT for each
/// segment; and the edges that say what has to hold (plan/plan_edges.h).

#include <locograph/core/graph.h>
#include <locograph/planners/offline/motion/motion_planner.h>
#include <locograph/planners/task/task.h>

namespace locograph {

/// The plan is marked incomplete where it has no success. Throws Error for a motion without
/// configurations or with a step whose stance is not known.
Graph motion_graph(const Task& task, const MotionPlan& plan);

}  // namespace locograph
