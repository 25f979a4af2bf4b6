#pragma once
/// Products of one block with a piece of a vector, for the conjugate gradients.
///
///     const PcgKernels& blocks = kernels().pcg(6);         // kernels.h: all blocks are 6 × 6
///     blocks.add(a, 6, 6, x, y);                           // y += A x

namespace locograph {

/// Functions for blocks of one size, from Kernels::pcg.
struct PcgKernels {
  /// y += A x and y += Aᵀ x for a rows × columns block.
  void (*add)(const double* a, int rows, int columns, const double* x, double* y);
  void (*add_transposed)(const double* a, int rows, int columns, const double* x, double* y);
  /// y = A x for a square block.
  void (*multiply)(const double* a, int size, const double* x, double* y);
};

}  // namespace locograph
