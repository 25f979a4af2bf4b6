#pragma once
/// Small dense kernels on column-major panels, without allocation: what the factorisations share.
///
///     const DenseKernels& dense = kernels().dense;                       // kernels.h
///     if (dense.cholesky_in_place(panel, ld, rows, columns) >= 0) return false;   // L₁₁ over L₂₁
///     dense.subtract_lower_product(c, ldc, panel + columns, ld, m, m, columns);   // C −= L₂₁ L₂₁ᵀ
///
/// Every element of a result is computed by the same sequence of operations wherever a panel is
/// cut, so the bits do not depend on how a product is divided among calls or threads. A product is
/// made in tiles of registers (Goto & van de Geijn 2008) straight from the panels: they are small
/// enough that packing costs more than it brings.

namespace locograph {

struct DenseKernels {
  int lanes;  ///< doubles in a vector register: a strip of a product is as wide

  /// Cholesky of the first `columns` columns of a panel of `rows` rows (rows ≥ columns): its top
  /// columns × columns block becomes L (lower triangle), the rows below become A₂₁ L⁻ᵀ. Only the
  /// lower triangle of the top block means anything; the upper is overwritten with anything.
  /// Returns -1, or the first column whose pivot is not positive.
  int (*cholesky_in_place)(double* panel, int leading_dimension, int rows, int columns);

  /// C −= A Bᵀ, C: m × n, A: m × k, B: n × k.
  void (*subtract_product)(double* c, int ldc, const double* a, int lda, const double* b, int ldb,
                           int m, int n, int k);

  /// C −= A Bᵀ on and below the diagonal, where B is the first n rows of A (m ≥ n); above it C is
  /// overwritten with anything.
  void (*subtract_lower_product)(double* c, int ldc, const double* a, int lda, int m, int n, int k);

  /// C = −A Bᵀ; `lower` as above: B is the first n rows of A and what is above the diagonal is
  /// anything.
  void (*negative_product)(double* c, int ldc, const double* a, int lda, const double* b, int ldb,
                           int m, int n, int k, bool lower);

  /// X ← X L⁻ᵀ for `rows` rows of n columns.
  void (*divide_rows)(double* x, int ldx, int rows, const double* l, int ldl, int n);

  /// x ← L⁻¹ x and x ← L⁻ᵀ x for a lower triangular n × n block.
  void (*solve_lower)(const double* l, int leading_dimension, int n, double* x);
  void (*solve_lower_transposed)(const double* l, int leading_dimension, int n, double* x);
};

}  // namespace locograph
