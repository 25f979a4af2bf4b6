#pragma once
/// A scenario: the robot, what it may touch with, the world around it, and what it is to do.
///
///     Scenario scenario = load_scenario("centauro_drive", data_folder);   // comes with locograph
///     Scenario other = load_scenario("hall.xml", data_folder);            // a file
///     World world = world_of(other);
///
/// The format is described in doc/scenarios.md. Every mistake is an Error with file and line.

#include <locograph/common/deadline.h>
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

/// Where a joint of the start stands [rad or m].
struct GivenJoint {
  std::string name;
  double position = 0.0;
  int line = 0;
};

/// From a start stance to goal stances, one after the other. Each stance is exactly its contacts.
struct ContactTask {
  /// Of the start: x y z qx qy qz qw, the quaternion normalised; none: wherever the posture solver
  /// finds it from the robot's state.
  std::optional<Eigen::Matrix<double, 7, 1>> base = std::nullopt;
  std::vector<GivenJoint> joints = {};  ///< that do not stand as in the robot's state
  Stance start;
  std::vector<Stance> goals;  ///< one or more
  int start_line = 0;
  std::vector<int> goal_lines = {};
};

/// A mesh, cloud or octree of the environment, as the file says it; it is opened by world_of().
struct ScannedSurface {
  enum class Kind { kMesh, kCloud, kOctomap };
  Kind kind = Kind::kMesh;
  std::string name;
  std::filesystem::path file;
  Eigen::Isometry3d world_from_mesh = Eigen::Isometry3d::Identity();
  double scale = 1.0;     ///< of a mesh, before it is moved
  double voxel_m = 0.05;  ///< of a cloud
  double friction = 0.0;  ///< as of surfaces
  int line = 0;
};

/// A camera of the scenario, as far as somebody has use for it.
struct GivenCamera {
  std::string name, link;
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
  std::vector<GivenCamera> cameras;  ///< the links are not looked for
  std::filesystem::path map;         ///< empty: none
  std::filesystem::path obstacles;   ///< empty: none
  std::vector<Surface> surfaces;     ///< that may be touched, in the order of the file
  std::vector<Bar> bars;
  std::vector<SolidBox> solids;         ///< whose faces are among the surfaces
  std::vector<ScannedSurface> scanned;  ///< where more of both are found
  bool enforce_torque_limits = true;
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

/// Throws Error with the line of the first camera that is on no link of the scenario's robot.
void require_camera_links(const Scenario& scenario, const Robot& robot);

/// The files that it is made of: its own, unless it comes with locograph, and those it names.
std::vector<std::filesystem::path> files_of(const Scenario& scenario);

/// Names of the scenarios that come with locograph, sorted.
std::vector<std::string> scenario_names(const std::filesystem::path& data_folder);

/// Names of the robots that come with locograph, sorted.
std::vector<std::string> robot_names(const std::filesystem::path& data_folder);

}  // namespace locograph
