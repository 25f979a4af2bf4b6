#include <locograph/solvers/cost_model.h>
#include <locograph/solvers/kernels.h>

namespace locograph {
namespace {

constexpr double kMultiplyAdd = 1.0 / 26e9;
constexpr double kPivot = 8e-9;
constexpr double kFront = 40e-9;
constexpr double kNumber = 0.16e-9;

/// Read often: an analysis weighs every front a few times.
const Kernels& registers() {
  static const Kernels& chosen = kernels();
  return chosen;
}

/// Whole registers and tiles are computed: what is padded costs as well. w, m: padded.
double products(double w, double m, int lanes) {
  return kMultiplyAdd * (w * w * w / 6.0 + 0.5 * w * w * m + 0.5 * w * m * (m + lanes));
}

}  // namespace

double front_seconds(int width, int below) {
  const Kernels& k = registers();
  const double w = k.padded(width), m = k.padded(below);
  return kFront + kPivot * width + products(w, m, k.lanes()) + kNumber * (m * m + width * (w + m));
}

double panel_seconds(int width, int below) {
  const Kernels& k = registers();
  const double w = k.padded(width), m = k.padded(below), height = k.padded(width + below);
  return kFront + kPivot * width + products(w, m, k.lanes()) + kNumber * width * height;
}

double ordering_seconds(int block_rows, int blocks) {
  return 0.2e-6 * block_rows + 0.1e-6 * blocks;
}

double dissection_seconds(int block_rows) { return 2e-6 * block_rows; }

}  // namespace locograph
