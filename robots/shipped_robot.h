#pragma once
/// The robots that come with locograph, by name: robots/models/NAME/NAME.urdf and .srdf.
///
///     if (const auto files = shipped_robot("centauro")) Robot::load(files->urdf, files->srdf);
///     std::string name = shipped_robot_name("a/arm.urdf", "a/arm.srdf");   // "": not one of them

#include <filesystem>
#include <optional>
#include <string>

namespace locograph {

struct RobotFiles {
  std::filesystem::path urdf, srdf;  ///< srdf: empty if there is none
};

/// With real paths, links followed. None for other names, and for names that are paths.
std::optional<RobotFiles> shipped_robot(const std::string& name);
/// That of another data folder.
std::optional<RobotFiles> shipped_robot(const std::string& name,
                                        const std::filesystem::path& data_folder);

/// The name of the robot whose files these are.
std::string shipped_robot_name(const std::filesystem::path& urdf,
                               const std::filesystem::path& srdf);

}  // namespace locograph
