#pragma once
/// The files of a robot that a command line names: one that comes along, or a URDF.
///
///     RobotFiles files = robot_files("centauro", "", data_folder());
///     RobotFiles own = robot_files("robots/arm.urdf", "", data_folder());   // robots/arm.srdf

#include <locograph/common/error.h>

#include <filesystem>
#include <string>

namespace locograph {

struct RobotFiles {
  std::filesystem::path urdf, srdf;  ///< srdf: empty if there is none
};

/// srdf: empty for the one of the same name beside the URDF, if there is one. Throws Error when
/// there is no such robot.
inline RobotFiles robot_files(const std::string& name_or_file, const std::string& srdf,
                              const std::filesystem::path& data_folder) {
  const std::filesystem::path own =
      data_folder / "robots/models" / name_or_file / (name_or_file + ".urdf");
  const bool by_name = name_or_file.find('/') == std::string::npos && std::filesystem::exists(own);
  if (!by_name && !std::filesystem::exists(name_or_file)) {
    throw Error(name_or_file, 0, "no such robot",
                "a URDF file, or a name that `locograph list robots` gives");
  }
  RobotFiles files;
  // The real folder: a graph's paths lead to the robot from wherever it is written.
  files.urdf = by_name ? std::filesystem::canonical(own) : std::filesystem::path(name_or_file);
  files.srdf = srdf;
  if (srdf.empty()) {
    files.srdf = files.urdf;
    files.srdf.replace_extension(".srdf");
    if (!std::filesystem::exists(files.srdf)) files.srdf.clear();
  }
  return files;
}

}  // namespace locograph
