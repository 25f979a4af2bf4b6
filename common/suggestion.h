#pragma once
/// What somebody meant who typed a name that does not exist.
///
///     throw Error("unknown robot '" + name + "'",
///                 "one of " + joined_names(known) + did_you_mean(name, known));
///     // unknown robot 'centaur', expected one of centauro, coman_plus; did you mean 'centauro'?

#include <string>
#include <string_view>
#include <vector>

namespace locograph {

/// How many letters must be added, removed, replaced or exchanged with their neighbour to make one
/// word of the other (optimal string alignment), upper and lower case alike.
int edit_distance(std::string_view a, std::string_view b);

/// "; did you mean 'NAME'?" with the nearest name: the one that typed begins, if no other does, or
/// the first one within a third of its letters. "" if none is near.
std::string did_you_mean(std::string_view typed, const std::vector<std::string>& names);

/// "one, two, three"
std::string joined_names(const std::vector<std::string>& names);

}  // namespace locograph
