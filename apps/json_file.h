#pragma once
/// Reads a JSON file of the user's.
///
///     const Json result = read_json("result.json", "what `optimize --json` prints");
///
/// Throws Error for a file that cannot be read, and with the line where it is no JSON.

#include <locograph/apps/output.h>

namespace locograph {

/// expected: what the file should be, for errors.
Json read_json(const std::filesystem::path& file, const std::string& expected);

}  // namespace locograph
