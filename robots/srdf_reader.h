#pragma once
/// Groups, named states and disabled collisions of an SRDF file, resolved against a URDF's names.
///
///     locograph::SrdfModel srdf = locograph::read_srdf("centauro.srdf", urdf, false);

#include <locograph/robots/urdf_reader.h>

#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace locograph {

struct SrdfModel {
  std::vector<JointGroup> groups;  ///< sorted by name
  std::vector<GroupState> states;  ///< sorted by name; states of one name and several groups merged
  std::set<std::pair<int, int>> disabled;  ///< link pairs, first < second
  std::set<std::pair<int, int>> enabled;   ///< exceptions to default_disabled
  std::set<int> default_disabled;          ///< links whose pairs are all disabled
  std::vector<std::string> warnings;

  bool is_disabled(int first, int second) const;
};

/// Throws Error with the line of the first element that names something the URDF does not have;
/// if `lenient`, skips that element and adds a warning instead.
SrdfModel read_srdf(const std::filesystem::path& file, const UrdfModel& urdf, bool lenient);

}  // namespace locograph
