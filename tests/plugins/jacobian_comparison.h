#pragma once
/// Compares analytic Jacobians of edges with numeric differences.
///
///     Evaluated evaluated(graph);
///     Compared compared;
///     for (int k = 0; k < kStates; ++k) compare(evaluated, k, 0, kEverywhere, compared);
///     EXPECT_EQ(compared.zero, 0);

#include "common/sanitized.h"
#include "plugins/plugin_test_support.h"

namespace locograph::test {

inline constexpr int kStates = kSanitized ? 12 : 120;
inline constexpr double kTolerance = 1e-6;
/// Numeric differences reach 6e-6 rad or m to either side, times an arm of a metre or two.
inline constexpr double kKink = 1e-4;

/// What was compared: rows with and without derivatives.
struct Compared {
  int rows = 0, nonzero = 0, zero = 0;
};

/// Compares the analytic Jacobian of edge k with numeric differences, in the rows that are smooth.
template <class Smooth>
void compare(Evaluated& evaluated, int k, int slot, Smooth smooth, Compared& compared) {
  const Eigen::MatrixXd analytic = evaluated.jacobian(k, slot, false);
  const Eigen::MatrixXd numeric = evaluated.jacobian(k, slot, true);
  ASSERT_EQ(analytic.rows(), numeric.rows());
  ASSERT_EQ(analytic.cols(), numeric.cols());
  ASSERT_TRUE(analytic.allFinite());
  for (int r = 0; r < analytic.rows(); ++r) {
    if (!smooth(r)) continue;
    const double scale = std::max(1.0, numeric.row(r).cwiseAbs().maxCoeff());
    ASSERT_LE((analytic.row(r) - numeric.row(r)).cwiseAbs().maxCoeff(), kTolerance * scale)
        << "edge " << k << ", slot " << slot << ", row " << r << "\nanalytic " << analytic.row(r)
        << "\nnumeric  " << numeric.row(r);
    ++compared.rows;
    ++(analytic.row(r).isZero(0.0) ? compared.zero : compared.nonzero);
  }
}

inline constexpr auto kEverywhere = [](int) { return true; };

}  // namespace locograph::test
