#pragma once
/// Plans a drive on wheels along a line or an arc, legs at rest.
///
///     const Task task = task_of(load_scenario("centauro_drive", data_folder));
///     const std::optional<Motion> drive = plan_wheeled_drive(task);
///     if (drive) write_graph(*drive_graph(task, *drive), "plan.g2o");      // drive_graph.h
///
/// The base follows the path at constant height, from rest to rest: at the drive's speed but for
/// whole steps at both ends, in which it speeds up and brakes by at most 0.5 m/s^2. Each wheel is
/// steered at right angles to the line from the instantaneous centre of rotation and turned as far
/// as its centre moves. The first configuration is the task's start state lifted so that the
/// wheels stand on z = 0, base above the origin, heading +x, wheels already steered into the arc.
/// Its one stance is that of all wheels on the ground.

#include <locograph/check/motion.h>
#include <locograph/common/job_control.h>
#include <locograph/planners/task/task.h>

#include <optional>

namespace locograph {

/// Nothing when the job ends before the motion is whole. Throws Error when the task is no drive,
/// when its wheels do not stand on one level in the start state, or when a wheel cannot be steered.
std::optional<Motion> plan_wheeled_drive(const Task& task, const JobControl& job = {});

}  // namespace locograph
