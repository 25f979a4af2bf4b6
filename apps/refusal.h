#pragma once
/// What other commands will make of a file that `info` describes.
///
///     const Loading loading = load_as_others_do("robot", "dog.urdf");
///     if (loading.refused) throw *loading.refused;

#include <locograph/common/error.h>
#include <locograph/planners/task/skin_frames.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace locograph {

struct Loading {
  std::optional<Error> refused;     ///< in their words; nothing: they take it
  std::vector<SkinFrame> off_skin;  ///< of a scenario
};

/// kind: as `info` tells it. What `posture` refuses of a robot, whatever the contacts, and `plan`
/// of a scenario: this loads what they load, and looks for a start. What takes longer than ten
/// seconds is not found out, nor is anything of other kinds.
Loading load_as_others_do(const std::string& kind, const std::filesystem::path& file);

}  // namespace locograph
