#pragma once
/// The arithmetic of one eliminated block column of a Schur complement.
///
/// The column holds blocks E_i (rows of kept vertices, K × D) above its diagonal block C (D × D).
/// With C + damping = L Lᵀ and W_i = E_i L⁻ᵀ,
///
///   E_i C⁻¹ E_jᵀ = W_i W_jᵀ,     E_i C⁻¹ b = W_i (L⁻¹ b),
///
/// so that one triangular factor serves the matrix, the right-hand side and the back-substitution.
/// Sizes that bundle adjustment and contact problems have are compiled in; any other size takes the
/// same code with sizes known at run time.

#include <cstdint>

namespace locograph {

/// Where an eliminated column lives. Its factor has the layout of its values: the blocks W_i one
/// after the other, then L.
struct SchurColumn {
  int blocks = 0;                      ///< kept rows it touches
  int dimension = 0;                   ///< D
  const int* row = nullptr;            ///< these rows, ascending
  const int* row_dimension = nullptr;  ///< K, by row
  const int* row_scalar = nullptr;     ///< first scalar row, by row
  double* factor = nullptr;
};

/// Functions of one pair of sizes, from Kernels::schur (kernels.h). All of them touch blocks first
/// ≤ i < last only where they take a range: a sum over columns that is split by kept rows has the
/// same bits as one that is not.
struct SchurKernels {
  /// factor ← W, L. False when C + damping is not positive definite.
  bool (*eliminate)(const SchurColumn&, const double* values, const double* damping);
  /// S(i, j) −= W_i W_jᵀ for first ≤ j < last, i ≤ j; place[j (j + 1) / 2 + i]: offset in s.
  void (*subtract_products)(const SchurColumn&, int first, int last, const std::int64_t* place,
                            double* s);
  /// D_i −= W_i W_iᵀ, block of row r at place[r].
  void (*subtract_squares)(const SchurColumn&, int first, int last, const std::int64_t* place,
                           double* d);
  /// t ← L⁻¹ t and t ← L⁻ᵀ t.
  void (*solve_lower)(const SchurColumn&, double* t);
  void (*solve_lower_transposed)(const SchurColumn&, double* t);
  /// y_i −= W_i t.
  void (*scatter)(const SchurColumn&, int first, int last, const double* t, double* y);
  /// t −= Σ W_iᵀ y_i.
  void (*gather)(const SchurColumn&, const double* y, double* t);
};

}  // namespace locograph
