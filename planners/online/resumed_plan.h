#pragma once
/// The rest of a plan, planned anew from where the robot has come to rest: its way is blocked, or a
/// place of a contact is taken.
///
///     ResumedPlan resumed = resume_plan(stopped_graph, task, world_now, {.seed = 7});
///     if (resumed.success()) graph = std::move(*resumed.graph);
///
/// Stances and motions are those of plan_motion() from the stance and the configuration that the
/// plan ends in to the goals that it has not reached, in the world as it is known now. The robot
/// stands while forces go over to those of the new motion, as at any change of stance. Balls that
/// are held go on rolling from where they touched down. Where nothing is found, or the judge
/// refuses what is put together, the next seeds are tried.

#include <locograph/core/graph.h>
#include <locograph/planners/answer/planner_answer.h>
#include <locograph/planners/offline/stance/stance_plan.h>
#include <locograph/planners/task/task.h>
#include <locograph/world/world_snapshot.h>

#include <memory>
#include <optional>

namespace locograph {

/// A world as it stands at a time: what moves stays where it is then, what is not there within
/// kStands_s of changing_obstacles.h is left out, and what appears meanwhile is where it appears.
World world_at_rest(const World& world, double time_s);

struct ResumedPlan : PlannerAnswer {
  double waits_s = 0.0;  ///< for a free way, see free_way.h
  /// With success: the plan as it was up to where it ended, in as many configurations, and the
  /// rest.
  std::optional<Graph> graph;
  double total_s = 0.0;
};

/// stopped: ends at rest, see cut_plan(). task: of its scenario, a contact task. world: nothing
/// moves in it. Throws Error as plan_of() and plan_motion() do.
ResumedPlan resume_plan(const Graph& stopped, const Task& task,
                        std::shared_ptr<const WorldSnapshot> world,
                        const StancePlannerOptions& options);

}  // namespace locograph
