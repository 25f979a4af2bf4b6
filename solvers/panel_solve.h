#pragma once
/// One right-hand side against one panel of a factor: the dense steps of forward and backward
/// substitution.
///
///     solve_panel(panel, ld, rows, columns, x);              // x₁ ← L₁₁⁻¹ x₁, x₂ ← x₂ − L₂₁ x₁
///     solve_panel_transposed(panel, ld, rows, columns, x);   // x₁ ← L₁₁⁻ᵀ (x₁ − L₂₁ᵀ x₂)
///
/// In a padded panel the rows under the pivots start at a multiple of the vector width; what is
/// between is skipped.

namespace locograph {

void solve_panel(const double* panel, int leading_dimension, int rows, int columns, double* x,
                 bool is_padded = false);
void solve_panel_transposed(const double* panel, int leading_dimension, int rows, int columns,
                            double* x, bool is_padded = false);

}  // namespace locograph
