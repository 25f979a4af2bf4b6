#pragma once
/// A scenario: the robot, where it may stand, the world around it, and what it is to do.
///
///     Scenario scenario = load_scenario("centauro_drive", data_folder);   // comes with locograph
///     Scenario other = load_scenario("hall.xml", data_folder);            // a file
///
/// The format is described in doc/scenarios.md. Every mistake is an Error with file and line.

#include <locograph/robots/robot.h>
#include <locograph/world/obstacles.h>

#include <filesystem>
#include <optional>
#include <string>
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

struct Scenario {
  std::string name;    ///< as given in the file
  std::string source;  ///< the name it was asked for by, or the file's path
  std::filesystem::path urdf, srdf;
  RobotOptions robot;
  std::string start_state = "home";
  struct NamedWheel {
    std::string link;
    double radius_m;
  };
  std::vector<NamedWheel> wheels;
  std::filesystem::path map;        ///< empty: none
  std::filesystem::path obstacles;  ///< empty: none
  std::optional<DriveTask> drive;
};

/// name_or_file: the name of a scenario that comes with locograph, or a path. data_folder: holds
/// scenarios/NAME.xml, and robots/models/NAME/NAME.urdf and .srdf for `<robot model="NAME">`.
Scenario load_scenario(const std::string& name_or_file, const std::filesystem::path& data_folder);

/// Names of the scenarios that come with locograph, sorted.
std::vector<std::string> scenario_names(const std::filesystem::path& data_folder);

}  // namespace locograph
