#pragma once
/// The loops that add rows of Jacobians to H, compiled once for each level of vector instructions
/// (common/simd_level.h). Internal: block_products.cpp calls them.

#include <locograph/common/level_table.h>

#include <cstdint>
#include <string>

namespace locograph {

inline constexpr int kMostRowsTogether = 8;

struct RowKernels {
  /// Bit c, c < n ≤ 64, tells whether from[c] is not 0; one that is not a number is not.
  std::uint64_t (*entries)(const double* from, int n);

  /// to[c * stride …] (n) += Σ_r weight_r right_r[c] left_r (n) for the `count` columns c that are
  /// listed; 1 ≤ rows ≤ kMostRowsTogether.
  void (*add_products)(int rows, const double* const* left, int n, const double* const* right,
                       const double* weight, const int* columns, int count, double* to,
                       long stride);
};

LOCOGRAPH_DECLARE_LEVELS(RowKernels, row_kernels);

/// Those of this process. Throws Error like simd_level().
const RowKernels& row_kernels();
/// Those of one of simd_levels(). Throws Error like require_simd_level().
const RowKernels& row_kernels_at(const std::string& level);

}  // namespace locograph
