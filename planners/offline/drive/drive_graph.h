#pragma once
/// A drive as a graph: what `locograph plan` writes.
///
///     const std::optional<Graph> graph = drive_graph(task, motion);
///     if (graph) write_graph(*graph, "plan.g2o");
///
/// One VERTEX_CONFIGURATION for each configuration with its time, its slopes and its stance, the
/// first one fixed, and the edges that say what has to hold (plan/plan_edges.h).

#include <locograph/check/motion.h>
#include <locograph/common/job_control.h>
#include <locograph/core/graph.h>
#include <locograph/planners/task/task.h>

#include <optional>

namespace locograph {

/// Nothing when the job ends before the graph is whole. Throws Error for files of the world that
/// cannot be used.
std::optional<Graph> drive_graph(const Task& task, const Motion& motion,
                                 const JobControl& job = {});

}  // namespace locograph
