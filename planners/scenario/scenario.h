#pragma once
/// A scenario: the robot, what it may touch with, the world around it, and what it is to do.
///
///     Scenario scenario = load_scenario("centauro_drive", data_folder);   // comes with locograph
///     Scenario other = load_scenario("hall.xml", data_folder);            // a file
///     World world = world_of(other);
///
/// The format is described in doc/scenarios.md. Every mistake is an Error with file and line.

#include <locograph/common/deadline.h>
#include <locograph/planners/scenario/contact_task.h>
#include <locograph/planners/scenario/scanned_surface.h>
#include <locograph/planners/scenario/scenario_camera.h>
#include <locograph/plugins/configuration/execution_margin.h>
#include <locograph/robots/contact.h>
#include <locograph/robots/robot.h>
#include <locograph/world/world.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace locograph {

/// A drive on wheels along a line or an arc.
struct DriveTask {
  double distance_m = 4.0;
  double curvature_1_m = 0.0;  ///< > 0 turns left
  double speed_m_s = 0.1;
  int configurations = 50;
  int line = 0;
};

/// Of the whole motion; 0: none.
struct MotionLimits {
  double base_linear_m_s = 0.0;
  double base_angular_rad_s = 0.0;
  double joint_acceleration_rad_s2 = 0.0;
};

/// What wheels bear that a scenario says nothing of.
inline constexpr double kWheelFriction = 0.8, kWheelForce_N = 5000.0;

struct Scenario {
  std::string name;    ///< as given in the file
  std::string source;  ///< the name of one that comes with locograph, or the file's absolute path
  std::filesystem::path urdf, srdf;
  RobotOptions robot;
  std::string start_state = "home";
  double effort_scale = 1.0;               ///< of the URDF's efforts
  std::vector<EndEffector> end_effectors;  ///< each with its friction; the links are not looked for
  std::vector<int> end_effector_lines;     ///< of the file
  MotionLimits limits;
  std::vector<ScenarioCamera> cameras;  ///< none: the robot's own
  std::filesystem::path map;            ///< empty: none
  std::filesystem::path obstacles;      ///< empty: none
  std::vector<Surface> surfaces;        ///< that may be touched, in the order of the file
  std::vector<Bar> bars;
  std::vector<SolidBox> solids;         ///< whose faces are among the surfaces
  std::vector<ScannedSurface> scanned;  ///< where more of both are found
  bool enforce_torque_limits = true;
  ExecutionMargin margin;
  /// One of the two.
  std::optional<DriveTask> drive;
  std::optional<ContactTask> contacts;
};

/// name_or_file: the name of a scenario that comes with locograph, or a path. data_folder: holds
/// scenarios/NAME.xml, and robots/models/NAME/NAME.urdf and .srdf for `<robot model="NAME">`.
Scenario load_scenario(const std::string& name_or_file, const std::filesystem::path& data_folder);

/// Its map, obstacles and solids, and what may be touched: surfaces and bars, then those that
/// are found in meshes, clouds and octrees (world/surfaces_of.h), called NAME 1 … and NAME bar
/// 1 …; for a drive without any of these the ground, the plane z = 0 without an end. Of clouds
/// and octrees rectangles of 0.2 m x 0.1 m or more, of octrees none that look down. Throws
/// Error for files that cannot be used and, with the line of the scenario, if there is nothing
/// in them to stand on. Throws OutOfTime when the deadline passes first.
World world_of(const Scenario& scenario, const Deadline& deadline = {});

/// The scenario's cameras on the links of its robot, or, without any, the robot's own. Throws Error
/// with the line of the first one whose link the robot does not have.
std::vector<DepthCamera> cameras_of(const Scenario& scenario, const Robot& robot);

/// The files that it is made of: its own, unless it comes with locograph, and those it names.
std::vector<std::filesystem::path> files_of(const Scenario& scenario);

/// Names of the scenarios that come with locograph, sorted.
std::vector<std::string> scenario_names(const std::filesystem::path& data_folder);

/// Names of the robots that come with locograph, sorted.
std::vector<std::string> robot_names(const std::filesystem::path& data_folder);

}  // namespace locograph
