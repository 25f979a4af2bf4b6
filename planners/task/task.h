#pragma once
/// What has to hold: the robot, the world, the limits, what end effectors can bear, where the robot
/// starts and where it goes. Made once from a scenario, and read by planners and judge alike.
///
///     const Task task = task_of(load_scenario("standing_up", data_folder));
///     const Judge judge(task.robot->robot, task.world);
///     const Stance& goal = task.goals.back();

#include <locograph/check/check_report.h>
#include <locograph/planners/scenario/scenario.h>
#include <locograph/planners/task/skin_frames.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/plugins/configuration/robot_parameters.h>
#include <locograph/world/world_snapshot.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace locograph {

struct Task {
  std::string scenario;  ///< that it was made from, see Scenario::source
  std::shared_ptr<const RobotParameter> robot;
  std::vector<DepthCamera> cameras;            ///< the scenario's, else the robot's own
  std::shared_ptr<const WorldSnapshot> world;  ///< with the files of map and obstacles
  /// Of a drive whose scenario names nothing to stand on: the height of the ground.
  std::optional<double> ground_z_m;
  ExecutionMargin margin;  ///< that planners keep to, and the judge does not ask for
  CheckOptions check;      ///< what the judge is asked: limits, and what end effectors can bear
  std::vector<SkinFrame> off_skin;  ///< end effectors whose frames are not on it
  std::string start_state;          ///< of the robot, see Scenario::start_state

  // A drive has neither start nor goals.
  Stance start;
  Eigen::VectorXd start_configuration;  ///< feasible for the start, once started_task() found it
  std::vector<Stance> goals;            ///< reached one after the other
  ContactMoves moves;                   ///< how start and goals differ from the scenario's

  std::optional<DriveTask> drive;

  const std::vector<EndEffector>& end_effectors() const { return check.known; }
};

/// Loads robot and world. Throws Error for a robot without collision shapes, for cameras on unknown
/// links and as world_of() does. Throws OutOfTime when the deadline passes first.
Task task_of(const Scenario& scenario, const Deadline& deadline = {});
/// Of the scenario's robot, which is loaded already, collision shapes or not; start and goals are
/// moved (task_stances.h).
Task task_of(const Scenario& scenario, std::shared_ptr<const RobotParameter> robot,
             const ContactMoves& moves, const Deadline& deadline = {});

}  // namespace locograph
