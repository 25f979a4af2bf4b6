#pragma once
/// Where the files that come with locograph are: robots/models/NAME/…, scenarios/NAME.xml
///
///     std::filesystem::path robots = data_folder() / "robots/models";
///
/// The folder is `share/locograph` beside the folder of the running program, or beside one of those
/// above it: PREFIX/share/locograph for PREFIX/bin/locograph, and a link to the source tree for
/// programs in a build folder. No path is compiled in, so an installed tree can be moved.

#include <locograph/common/error.h>

#include <filesystem>
#include <system_error>

namespace locograph {

/// Throws Error when there is none.
inline std::filesystem::path data_folder() {
  std::error_code failed;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failed);
  for (std::filesystem::path folder = program.parent_path();
       !failed && folder != folder.parent_path(); folder = folder.parent_path()) {
    std::filesystem::path candidate = folder / "share/locograph";
    if (std::filesystem::is_directory(candidate / "robots/models")) return candidate;
  }
  throw Error(program.string(), 0, "the data folder is missing",
              "share/locograph/robots/models beside the program's folder");
}

}  // namespace locograph
