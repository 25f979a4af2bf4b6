#pragma once
/// What one edge adds to H and b, on plain blocks of numbers stored column by column: loops where
/// the sizes are known when an edge type is compiled, Eigen's products behind a function of the
/// core where they are not. An edge type so costs a compiler nothing but its own error.

#include <locograph/core/edge_pool.h>

namespace locograph::detail {

/// weighted (d × n) = w Jᵀ Ω, of J (n × d) and a symmetric Ω (n × n).
void weight_jacobian(int n, int d, const double* jacobian, const double* information, double w,
                     double* weighted);
/// weighted (d × n) = Jᵀ Ω becomes Jᵀ (Ω + β Ωe (Ωe)ᵀ); `along` holds d numbers.
void bend_weighted(int n, int d, const double* information, const double* error, double beta,
                   double* weighted, double* along);
/// block (a × b) += W J, of W (a × n) and J (n × b); its transpose into (b × a) if asked.
void add_product(int n, int a, int b, const double* weighted, const double* jacobian,
                 bool transposed, double* block);
/// The same of edge k with diagonal Ω, over the entries that are not zero: H += w Ω_r gᵀg,
/// b += w Ω_r e_r g, of the rows g of its Jacobians (n × d, stored row by row). Rows one after the
/// other that have nearly the same columns, as those of one foot, are added together. Rows from
/// `diagonal` on have an entry in their own column alone, those before it in columns before it; of
/// the Jacobians nothing else is read then. n: they are as they like.
void add_rows(const CompiledEdges& compiled, int k, int n, int diagonal, const double* error,
              const double* weights, double w, bool one_sided, double* const* jacobians,
              Scratch& scratch, double* hessian, double* gradient);

/// sum (a) += L r, of L (a × n) and r (n): unrolled, so that the sum stays in registers.
template <int N, int A>
inline void add_column(const double* __restrict left, const double* __restrict right,
                       double* __restrict sum) {
#pragma GCC unroll 16
  for (int p = 0; p < N; ++p) {
#pragma GCC unroll 16
    for (int r = 0; r < A; ++r) sum[r] += left[p * A + r] * right[p];
  }
}

template <int N, int D>
void weight_jacobian(int n, int d, const double* __restrict jacobian,
                     const double* __restrict information, double w, double* __restrict weighted) {
  if constexpr (N == Eigen::Dynamic || D == Eigen::Dynamic) {
    weight_jacobian(n, d, jacobian, information, w, weighted);
  } else {
    double transposed[N * D];
    for (int c = 0; c < D; ++c) {
      for (int r = 0; r < N; ++r) transposed[r * D + c] = w * jacobian[c * N + r];
    }
    for (int q = 0; q < N; ++q) {
      double sum[D] = {};
      add_column<N, D>(transposed, information + q * N, sum);
#pragma GCC unroll 16
      for (int c = 0; c < D; ++c) weighted[q * D + c] = sum[c];
    }
  }
}

/// The same for every column of J; entry (r, c) of the block stands at r·Row + c·Column.
template <int N, int A, int B, int Row, int Column>
inline void add_columns(const double* __restrict weighted, const double* __restrict jacobian,
                        double* __restrict block) {
  for (int c = 0; c < B; ++c) {
    double sum[A];
#pragma GCC unroll 16
    for (int r = 0; r < A; ++r) sum[r] = block[r * Row + c * Column];
    add_column<N, A>(weighted, jacobian + c * N, sum);
#pragma GCC unroll 16
    for (int r = 0; r < A; ++r) block[r * Row + c * Column] = sum[r];
  }
}

template <int N, int A, int B>
void add_product(int n, int a, int b, const double* weighted, const double* jacobian,
                 bool transposed, double* block) {
  if constexpr (N == Eigen::Dynamic || A == Eigen::Dynamic || B == Eigen::Dynamic) {
    add_product(n, a, b, weighted, jacobian, transposed, block);
  } else if (transposed) {
    add_columns<N, A, B, B, 1>(weighted, jacobian, block);
  } else {
    add_columns<N, A, B, 1, A>(weighted, jacobian, block);
  }
}

}  // namespace locograph::detail
