#pragma once
/// A motion that has come to rest, and one that goes on from there, as one.
///
///     const MotionPlan whole = continued(task, executed, segments, rest);
///     const Graph graph = motion_graph(task, whole);

#include <locograph/check/judge.h>
#include <locograph/core/graph.h>
#include <locograph/planners/offline/motion/motion_planner.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/task/task.h>

#include <vector>

namespace locograph {

/// The robot stands in between while forces go over, and at least for waits_s. Contacts that are
/// held on stay where they touched down. executed, with its segments, ends at rest where rest
/// begins; it becomes the first part, in as many configurations.
MotionPlan continued(const Task& task, Motion executed, const std::vector<PlanSegment>& segments,
                     const MotionPlan& rest, double waits_s = 0.0);

int last_configuration(const Graph& graph);

/// The configuration from which all balls that are held at another one are held: how much their
/// skins slip is counted from there.
int held_balls_since(const Plan& plan, int configuration);
/// Of a plan that goes on from one of its configurations, what the judge says from there on and, of
/// balls that were held before, from where they touched down, then among what may be touched alone:
/// what was in the way was another world then. stopped: the plan as it was executed.
CheckReport judged_on(const Plan& stopped, const Graph& graph, const Judge& judge,
                      const Task& task);

/// What the judge says of a plan from one of its configurations on.
CheckReport judged_from(int configuration, int last, const Graph& graph, const Judge& judge,
                        CheckOptions options);

}  // namespace locograph
