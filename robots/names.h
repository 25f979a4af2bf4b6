#pragma once
/// Suggestions for a name that does not exist, and names listed.
///
///     throw Error(file, line, "no link 'weel_1'", similar_names("weel_1", {"wheel_1", "pelvis"}));
///     // ... no link 'weel_1', expected one like 'wheel_1', 'pelvis'

#include <string>
#include <vector>

namespace locograph {

/// Up to three of the candidates, least edit distance first, as text for an Error.
std::string similar_names(const std::string& name, const std::vector<std::string>& candidates);

/// "a, b and c"; of more than eight the first eight, "and 13 more".
std::string listed_names(const std::vector<std::string>& names);

}  // namespace locograph
