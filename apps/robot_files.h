#pragma once
/// The files of a robot that a command line names: one that comes along, or a URDF.
///
///     RobotFiles files = robot_files("centauro", "");
///     RobotFiles own = robot_files("robots/arm.urdf", "");   // robots/arm.srdf

#include <locograph/common/data_folder.h>
#include <locograph/common/error.h>
#include <locograph/common/suggestion.h>
#include <locograph/planners/scenario/scenario.h>
#include <locograph/robots/shipped_robot.h>

#include <filesystem>
#include <string>

namespace locograph {

/// srdf: empty for the one of the same name beside the URDF, if there is one. Throws Error when
/// there is no such robot.
inline RobotFiles robot_files(const std::string& name_or_file, const std::string& srdf) {
  RobotFiles files;
  std::error_code too_long;
  if (const auto ours = shipped_robot(name_or_file)) {
    files = *ours;
  } else if (std::filesystem::exists(name_or_file, too_long)) {
    files.urdf = files.srdf = name_or_file;
    files.srdf.replace_extension(".srdf");
    if (!std::filesystem::exists(files.srdf)) files.srdf.clear();
  } else {
    throw Error(name_or_file, 0, "no such robot",
                "a URDF file, or a name that `locograph list robots` gives" +
                    did_you_mean(name_or_file, robot_names(data_folder())));
  }
  if (!srdf.empty()) files.srdf = srdf;
  return files;
}

}  // namespace locograph
