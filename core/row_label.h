#pragma once
/// What one row of an edge's error is called, and in which unit it counts: for people who read that
/// a constraint is violated.

#include <string>

namespace locograph {

struct RowLabel {
  std::string name;  ///< "knee_pitch_1 above its upper limit"; empty where the type has none
  std::string unit;  ///< "rad", "N m"; empty where the type names none
};

}  // namespace locograph
