#pragma once
/// The kernels of this folder, compiled for several sets of vector instructions in one library, and
/// the choice among them.
///
///     const Kernels& k = kernels();                             // chosen once, for this machine
///     k.dense.cholesky_in_place(panel, ld, rows, columns);
///     std::cout << k.level << '\n';                             // "v3"
///
/// Levels, and which of them a process runs at: common/simd_level.h.
///
/// A result has the same bits however its computation is divided, at every level; two levels round
/// differently.

#include <locograph/solvers/dense_kernels.h>
#include <locograph/solvers/front_kernels.h>
#include <locograph/solvers/panel_solve.h>
#include <locograph/solvers/pcg_kernels.h>
#include <locograph/solvers/schur_kernels.h>

#include <string>

namespace locograph {

struct Kernels {
  const char* level;
  const DenseKernels& dense;
  const FrontKernels& front;
  const PanelSolve& panel;
  /// For eliminated columns of `dimension` and rows of `rows` all; 0: rows of different dimensions.
  const SchurKernels& (*schur)(int rows, int dimension);
  /// For blocks of dimension × dimension all; 0: of different sizes.
  const PcgKernels& (*pcg)(int dimension);

  int lanes() const { return dense.lanes; }
  /// Rows in memory, so that what follows starts at a whole register.
  int padded(int count) const { return (count + lanes() - 1) & -lanes(); }
};

/// Those that run in this process. What one function lays out in memory another reads, so there is
/// no second choice. Throws Error like simd_level().
const Kernels& kernels();

/// Those of one of simd_levels(). Throws Error like require_simd_level().
const Kernels& kernels_at(const std::string& level);

}  // namespace locograph
