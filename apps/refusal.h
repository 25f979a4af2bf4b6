#pragma once
/// Whether other commands will take a file that `info` describes, in the words that they have for
/// it.
///
///     if (const std::optional<Error> refused = refusal_of("robot", "dog.urdf")) throw *refused;

#include <locograph/common/error.h>

#include <filesystem>
#include <optional>
#include <string>

namespace locograph {

/// kind: as `info` tells it. What `posture` refuses of a robot, whatever the contacts, and `plan`
/// of a scenario: this loads what they load, and looks for a start. Nothing: they take it, or it is
/// neither.
std::optional<Error> refusal_of(const std::string& kind, const std::filesystem::path& file);

}  // namespace locograph
