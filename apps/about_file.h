#pragma once
/// Gives errors that name no file the one that they are about.
///
///     Plan plan = about_file("plan.g2o", [&] { return plan_of(graph); });
///     // what(): plan.g2o:3: a second PARAMS_PLAN in a plan, expected one

#include <locograph/common/error.h>

#include <string>

namespace locograph {

/// What f() returns.
template <class F>
auto about_file(const std::string& file, F&& f) {
  try {
    return f();
  } catch (const Error& error) {
    if (!error.file().empty()) throw;
    // Without a file, what() begins with the line if there is one.
    const std::string what = error.what(), line = "line " + std::to_string(error.line()) + ": ";
    const bool told = error.line() > 0 && what.starts_with(line);
    throw Error(file, error.line(), told ? what.substr(line.size()) : what, "");
  }
}

}  // namespace locograph
