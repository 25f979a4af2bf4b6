#pragma once
/// A whole motion for a contact task: stances, a path in each, and when.
///
///     const Task task = started_task(scenario).task;
///     const MotionPlan plan = plan_motion(task, {.seed = 7});
///     if (plan.success()) write_graph(motion_graph(task, plan), "plan.g2o");
///
/// Each stance that the stance planner finds is a segment: a path between the configurations in
/// which it begins and ends (segment_planner.h), with the fastest timing from rest to rest
/// (timing/path_timing.h). The stance planner hands out one candidate after the other
/// (stance_search.h): where a segment is solved by no planner, its change of stance is refused, and
/// the next candidate does without. The whole motion is judged (check/judge.h) before it counts.

#include <locograph/check/check_report.h>
#include <locograph/check/motion.h>
#include <locograph/planners/offline/motion/motion_options.h>
#include <locograph/planners/offline/motion/segment_record.h>
#include <locograph/planners/offline/stance/stance_plan.h>
#include <locograph/planners/task/task.h>

#include <vector>

namespace locograph {

struct MotionStatistics : PlannerStatistics {  // iterations: of the stance planner
  int refused_segments = 0;                    ///< told to the stance planner
  double path_s = 0.0, timing_s = 0.0;         ///< of all segments
  double judge_s = 0.0;
};

struct MotionPlan : PlannerAnswer {
  StancePlan stances;
  /// Without success as far as it got: the segments up to the first that has none. With the least
  /// wrenches, where the task's margin has a dwell in which they can go over.
  Motion motion;
  std::vector<SegmentRecord> segments;
  CheckReport report;  ///< of the motion
  MotionStatistics statistics;
};

/// The termination is that of the stance planner, and ends segments as well. Contacts are put only
/// where they can be approached, whatever the options say
/// (StancePlannerOptions::approachable_only).
MotionPlan plan_motion(const Task& task, const StancePlannerOptions& stances,
                       const MotionOptions& options = {});

}  // namespace locograph
