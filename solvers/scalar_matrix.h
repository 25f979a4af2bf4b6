#pragma once
/// A block-sparse matrix as scalars, upper triangle in compressed columns: what solvers that know
/// no blocks are given.
///
///     ScalarMatrix matrix(pattern);
///     matrix.set(pattern, values, damping);         // damping on the diagonal
///     Eigen::Map<const Eigen::SparseMatrix<double>> upper(
///         matrix.size, matrix.size, matrix.begin.back(), matrix.begin.data(), matrix.row.data(),
///         matrix.value.data());                     // or the arrays of a cholmod_sparse

#include <locograph/core/block_matrix.h>

#include <vector>

namespace locograph {

struct ScalarMatrix {
  int size = 0;
  std::vector<int> begin;  ///< size + 1 entries
  std::vector<int> row;    ///< ascending in each column, the diagonal last
  std::vector<double> value;

  ScalarMatrix() = default;
  explicit ScalarMatrix(const BlockPattern& pattern);
  void set(const BlockPattern& pattern, const double* values, const double* damping);
};

/// Block row at which the Cholesky factorisation of this matrix fails, for solvers that do not say;
/// -1 if ours does not fail.
int find_failed_row(const BlockPattern& pattern, const double* values, const double* damping);

}  // namespace locograph
