#pragma once
/// One right-hand side against one panel of a factor: the dense steps of forward and backward
/// substitution.
///
///     solve_panel(panel, ld, columns, x);               // x₁ ← L₁₁⁻¹ x₁, x₂ ← x₂ − L₂₁ x₁
///     solve_panel_transposed(panel, ld, columns, x);    // x₁ ← L₁₁⁻ᵀ (x₁ − L₂₁ᵀ x₂)
///
/// The panel has ld rows, a multiple of the vector width, as has x; rows between the pivots and the
/// next multiple are zero in both, and so are rows after the last.

namespace locograph {

void solve_panel(const double* panel, int leading_dimension, int columns, double* x);
void solve_panel_transposed(const double* panel, int leading_dimension, int columns, double* x);

}  // namespace locograph
