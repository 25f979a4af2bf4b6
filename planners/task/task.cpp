#include <locograph/planners/task/task.h>
#include <locograph/planners/task/task_stances.h>

#include <utility>

namespace locograph {
namespace {

constexpr double kGround_m = 0.0;

CheckOptions check_of(const Scenario& scenario) {
  CheckOptions check;
  check.known = scenario.end_effectors;
  check.base_linear_m_s = scenario.limits.base_linear_m_s;
  check.base_angular_rad_s = scenario.limits.base_angular_rad_s;
  check.joint_acceleration_rad_s2 = scenario.limits.joint_acceleration_rad_s2;
  check.enforce_torque_limits = scenario.enforce_torque_limits;
  check.effort_scale = scenario.effort_scale;
  return check;
}

}  // namespace

Task task_of(const Scenario& scenario, const Deadline& deadline) {
  auto robot = std::make_shared<const RobotParameter>(scenario.urdf, scenario.srdf, scenario.robot);
  robot->robot->require_collision_shapes();
  return task_of(scenario, std::move(robot), {}, deadline);
}

Task task_of(const Scenario& scenario, std::shared_ptr<const RobotParameter> robot,
             const ContactMoves& moves, const Deadline& deadline) {
  Task task;
  task.cameras = cameras_of(scenario, *robot->robot);
  task.scenario = scenario.source;
  task.robot = std::move(robot);
  task.world = std::make_shared<const WorldSnapshot>(
      world_of(scenario, deadline), 0.0,
      WorldFiles{.map = scenario.map, .obstacles = scenario.obstacles});
  // Where the scenario names what there is to stand on, that is all there is, as in world_of().
  const bool on_ground = scenario.surfaces.empty() && scenario.scanned.empty();
  if (scenario.drive && on_ground) task.ground_z_m = kGround_m;
  task.check = check_of(scenario);
  task.off_skin = snap_to_skin(*task.robot->robot, task.check.known);
  task.margin = scenario.margin;
  task.start_state = scenario.start_state;
  task.drive = scenario.drive;
  if (!scenario.contacts) return task;
  TaskStances stances = task_stances(scenario, task.end_effectors(), task.world->world(), moves);
  task.start = std::move(stances.start);
  task.goals = std::move(stances.goals);
  task.moves = moves;
  return task;
}

}  // namespace locograph
