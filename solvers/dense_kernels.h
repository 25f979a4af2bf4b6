#pragma once
/// Small dense kernels on column-major panels, without allocation: what the factorisations share.

namespace locograph {

/// Cholesky of the first `columns` columns of a panel of `rows` rows (rows ≥ columns): its top
/// columns × columns block becomes L (lower triangle), the rows below become A₂₁ L⁻ᵀ. Only the
/// lower triangle of the top block is read. Returns -1, or the first column whose pivot is not
/// positive.
int cholesky_in_place(double* panel, int leading_dimension, int rows, int columns);

/// C −= A Bᵀ, C: m × n, A: m × k, B: n × k.
void subtract_product(double* c, int ldc, const double* a, int lda, const double* b, int ldb, int m,
                      int n, int k);

/// x ← L⁻¹ x and x ← L⁻ᵀ x for a lower triangular n × n block.
void solve_lower(const double* l, int leading_dimension, int n, double* x);
void solve_lower_transposed(const double* l, int leading_dimension, int n, double* x);

}  // namespace locograph
