#pragma once
/// The kernels of this folder, compiled for several sets of vector instructions in one library, and
/// the choice among them.
///
///     const Kernels& k = kernels();                             // chosen once, for this machine
///     k.dense.cholesky_in_place(panel, ld, rows, columns);
///     std::cout << k.level << '\n';                             // "v3"
///
/// The levels are those of x86-64: v2 (two lanes), v3 (AVX2: four lanes, fused multiply-add), v4
/// (AVX-512: eight lanes). For other processors there is one, "portable". The highest that the
/// machine has is taken, unless the environment variable LOCOGRAPH_SIMD names another.
///
/// A result has the same bits however its computation is divided, at every level; two levels round
/// differently.

#include <locograph/solvers/dense_kernels.h>
#include <locograph/solvers/front_kernels.h>
#include <locograph/solvers/panel_solve.h>
#include <locograph/solvers/pcg_kernels.h>
#include <locograph/solvers/schur_kernels.h>

#include <string>
#include <vector>

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
/// no second choice. Throws Error when LOCOGRAPH_SIMD names no level, or one that the machine
/// lacks.
const Kernels& kernels();

/// The levels that this machine has, lowest first, and the kernels of one of them. Throws Error
/// like kernels().
std::vector<std::string> kernel_levels();
const Kernels& kernels_at(const std::string& level);

}  // namespace locograph
