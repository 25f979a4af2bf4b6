#pragma once
/// Where the files that come with locograph are: robots/models/NAME/…, scenarios/NAME.xml
///
///     std::filesystem::path robots = data_folder() / "robots/models";
///
/// The folder is `share/locograph` beside the folder of the running program, or beside one of those
/// above it: PREFIX/share/locograph for PREFIX/bin/locograph, and a link to the source tree for
/// programs in a build folder. No path is compiled in, so an installed tree can be moved. Programs
/// elsewhere are told by the variable LOCOGRAPH_DATA, which goes first.

#include <filesystem>
#include <optional>

namespace locograph {

std::optional<std::filesystem::path> find_data_folder();
/// Throws Error when there is none.
std::filesystem::path data_folder();

}  // namespace locograph
