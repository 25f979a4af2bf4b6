#pragma once
/// Suggestions for a name that does not exist.
///
///     throw Error(file, line, "no link 'weel_1'", similar_names("weel_1", {"wheel_1", "pelvis"}));
///     // ... no link 'weel_1', expected one like 'wheel_1', 'pelvis'

#include <string>
#include <vector>

namespace locograph {

/// Up to three of the candidates, least edit distance first, as text for an Error.
std::string similar_names(const std::string& name, const std::vector<std::string>& candidates);

}  // namespace locograph
