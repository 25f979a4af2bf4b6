#pragma once
/// The files of a robot that a command line names: one that comes along, or a URDF.
///
///     RobotFiles files = robot_files("centauro", "");
///     RobotFiles own = robot_files("robots/arm.urdf", "");   // robots/arm.srdf

#include <locograph/common/data_folder.h>
#include <locograph/common/error.h>
#include <locograph/common/suggestion.h>
#include <locograph/planners/scenario/scenario.h>
#include <locograph/robots/names.h>
#include <locograph/robots/robot.h>
#include <locograph/robots/shipped_robot.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace locograph {

/// The SRDF of the same name beside a URDF; empty where there is none.
inline std::filesystem::path srdf_beside(const std::filesystem::path& urdf) {
  const std::filesystem::path srdf = std::filesystem::path(urdf).replace_extension(".srdf");
  std::error_code too_long;
  return std::filesystem::exists(srdf, too_long) ? srdf : std::filesystem::path();
}

/// srdf: empty for the one of the same name beside the URDF, if there is one. Throws Error when
/// there is no such robot.
inline RobotFiles robot_files(const std::string& name_or_file, const std::string& srdf) {
  RobotFiles files;
  std::error_code too_long;
  if (const auto ours = shipped_robot(name_or_file)) {
    files = *ours;
  } else if (std::filesystem::exists(name_or_file, too_long)) {
    files.urdf = name_or_file;
    files.srdf = srdf_beside(files.urdf);
  } else {
    throw Error(name_or_file, 0, "no such robot",
                "a URDF file, or a name that `locograph list robots` gives" +
                    did_you_mean(name_or_file, robot_names(data_folder())));
  }
  if (!srdf.empty()) files.srdf = srdf;
  return files;
}

/// A line that names the links with something to see and nothing to collide; empty without any.
inline std::string shapeless_text(const std::vector<std::string>& links) {
  return links.empty() ? "" : "without a collision shape: " + listed_names(links) + '\n';
}

}  // namespace locograph
