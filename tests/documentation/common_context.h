#pragma once
/// What the examples of common/ take for granted.

// Throws: common/error.h
// Throws: common/suggestion.h

#include <documentation/example_context.h>
#include <locograph/common/error.h>
#include <locograph/common/simd.h>
#include <locograph/common/uniform.h>

#include <csignal>

namespace locograph::documentation::in_common {

struct Context {
  const std::string text = "<robot/>", name = "centaur", file = "robot.urdf";
  const int line = 12;
  const double x = 0.5, tolerance = 1e-6;
  const std::vector<std::string> known = {"centauro", "coman_plus"};
  const Eigen::Vector3d v = {1.0, 2.0, 3.0}, w = {0.0, 0.0, 1.0};
  const int chunks = 8;
  std::vector<double> sums = std::vector<double>(8);

  static double sum(int chunk) { return 0.5 * chunk; }
  static void try_another_start() {}
};

namespace input_file_h {
struct Context : in_common::Context {
  Context() { write_example_file("robot.urdf", text); }
};
}  // namespace input_file_h
namespace simd_h {
using namespace simd_portable;
struct Context {
  std::vector<double> numbers = std::vector<double>(8, 1.0), results = numbers;
  const double* from = numbers.data();
  double* to = results.data();
};
}  // namespace simd_h
namespace stop_signals_h {
struct Context : in_common::Context {
  /// As if somebody pressed Ctrl-C.
  static void try_another_start() { std::raise(SIGINT); }
};
}  // namespace stop_signals_h

}  // namespace locograph::documentation::in_common
