#include <locograph/solvers/cost_model.h>
#include <locograph/solvers/kernels.h>

namespace locograph {
namespace {

constexpr double kMultiplyAdd = 1.0 / 26e9;
constexpr double kPivot = 8e-9;
constexpr double kFront = 40e-9;
constexpr double kNumber = 0.16e-9;

/// Whole registers and tiles are computed: what is padded costs as well.
double products(int width, int below) {
  const Kernels& k = kernels();
  const double w = k.padded(width), m = k.padded(below);
  return kMultiplyAdd * (w * w * w / 6.0 + 0.5 * w * w * m + 0.5 * w * m * (m + k.lanes()));
}

}  // namespace

double front_seconds(int width, int below) {
  const Kernels& k = kernels();
  const double w = k.padded(width), m = k.padded(below);
  return kFront + kPivot * width + products(width, below) + kNumber * (m * m + width * (w + m));
}

double panel_seconds(int width, int below) {
  const double height = kernels().padded(width + below);
  return kFront + kPivot * width + products(width, below) + kNumber * width * height;
}

double ordering_seconds(int block_rows, int blocks) {
  return 0.2e-6 * block_rows + 0.1e-6 * blocks;
}

double dissection_seconds(int block_rows) { return 2e-6 * block_rows; }

}  // namespace locograph
