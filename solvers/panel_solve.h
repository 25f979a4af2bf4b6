#pragma once
/// One right-hand side against one panel of a factor: the dense steps of forward and backward
/// substitution.
///
///     const PanelSolve& panels = kernels().panel;           // kernels.h
///     panels.forward(panel, ld, rows, columns, x, false);   // x₁ ← L₁₁⁻¹ x₁, x₂ ← x₂ − L₂₁ x₁
///     panels.backward(panel, ld, rows, columns, x, false);  // x₁ ← L₁₁⁻ᵀ (x₁ − L₂₁ᵀ x₂)
///
/// In a padded panel the rows under the pivots start at a multiple of the vector width; what is
/// between is skipped.

namespace locograph {

struct PanelSolve {
  void (*forward)(const double* panel, int leading_dimension, int rows, int columns, double* x,
                  bool is_padded);
  void (*backward)(const double* panel, int leading_dimension, int rows, int columns, double* x,
                   bool is_padded);
};

}  // namespace locograph
