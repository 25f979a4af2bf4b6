#pragma once
/// Sizes, distances and resolutions: lengths that are above 0 and finite.
///
///     const double radius = require_metres(0.05, "radius of a shape");
///     // with -0.05: radius of a shape is -0.050000, expected a positive number of metres

#include <locograph/common/error.h>

#include <cmath>
#include <string>

namespace locograph {

/// The value. Throws Error for another.
inline double require_metres(double value, const char* what) {
  if (!std::isfinite(value) || value <= 0.0)
    throw Error(std::string(what) + " is " + std::to_string(value), "a positive number of metres");
  return value;
}

}  // namespace locograph
