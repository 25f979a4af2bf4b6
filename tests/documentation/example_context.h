#pragma once
/// What the examples of all headers take for granted: header_examples.awk puts each into a function
/// of a namespace of its own, in_FOLDER::FILE_h, and FOLDER_context.h declares the names they use.
/// Nothing is ever linked or run.

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace locograph::documentation {

/// What an example may return.
struct Anything {
  Anything() = default;
  Anything(int) {}
};

}  // namespace locograph::documentation
