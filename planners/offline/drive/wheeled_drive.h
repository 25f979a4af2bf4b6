#pragma once
/// Plans a drive on wheels along a line or an arc, legs at rest.
///
///     const Task task = task_of(load_scenario("centauro_drive", data_folder));
///     const DrivePlan plan = plan_wheeled_drive(task);
///     if (plan.success())
///       write_graph(*drive_graph(task, plan.motion), "plan.g2o");          // drive_graph.h
///
/// The base follows the path at constant height, from rest to rest: at the drive's speed but for
/// whole steps at both ends, in which it speeds up and brakes by at most 0.5 m/s^2. Each wheel is
/// steered at right angles to the line from the instantaneous centre of rotation and turned as far
/// as its centre moves. The first configuration is the task's start state lifted so that the
/// wheels stand on z = 0, base above the origin, heading +x, wheels already steered into the arc.
/// Its one stance is that of all wheels on the ground.

#include <locograph/check/motion.h>
#include <locograph/common/job_control.h>
#include <locograph/planners/answer/planner_answer.h>
#include <locograph/planners/task/task.h>

namespace locograph {

struct DrivePlan : PlannerAnswer {
  Motion motion = {};  ///< without success as far as it got
  PlannerStatistics statistics = {};
};

/// Only the job keeps it from success; nothing is iterated. Throws Error when the task is no drive,
/// when its wheels do not stand on one level in the start state, or when a wheel cannot be steered.
DrivePlan plan_wheeled_drive(const Task& task, const JobControl& job = {});

}  // namespace locograph
