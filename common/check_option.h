#pragma once
/// For `validate()` of options: an Error that names the option and what it may be.
///
///     check_option(tolerance > 0.0, "tolerance", "a positive number");
///     // what(): option tolerance is out of range, expected a positive number

#include <locograph/common/error.h>

namespace locograph {

inline void check_option(bool good, const char* option, const char* expected) {
  if (!good) throw Error(std::string("option ") + option + " is out of range", expected);
}

}  // namespace locograph
