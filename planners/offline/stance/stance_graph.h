#pragma once
/// A plan of stances as a graph: what `locograph plan --stances-only` writes.
///
///     Graph graph = stance_graph(task, plan);
///     write_graph(graph, "stances.g2o");
///
/// One VERTEX_CONFIGURATION for each stance, in the stance that it is left in, at rest with its
/// number as its time, the first one fixed; VERTEX_WRENCHES of the contacts that balance it, those
/// of the smaller of its two stances; and the edges that say so (plan/plan_edges.h).

#include <locograph/core/graph.h>
#include <locograph/planners/offline/stance/stance_plan.h>
#include <locograph/planners/task/task.h>

namespace locograph {

/// What a plan says of itself (PARAMS_PLAN).
struct TaskPlanKind {
  bool stances_only = false;
  bool incomplete = false;  ///< it ends before its goal
};

/// Adds the parameters of a plan for a contact task: robot, world, scenario, the plan itself and
/// its stances, whose numbers are returned.
std::vector<int> add_task(Graph& graph, const Task& task, const std::vector<Stance>& stances,
                          const TaskPlanKind& kind);

/// The plan is marked incomplete where it has no success.
Graph stance_graph(const Task& task, const StancePlan& plan);

}  // namespace locograph
