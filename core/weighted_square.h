#pragma once
/// What Ω of an edge makes of vectors, without a matrix where Ω is diagonal: of thousands of rows
/// it would take gigabytes.
///
///     const double chi2 = weighted_square(pool, index, error);   // eᵀΩe

#include <locograph/core/edge_pool.h>

namespace locograph {

/// Ωv, for each column of v.
inline Eigen::MatrixXd weighted(const EdgePool& pool, int index, const Eigen::MatrixXd& v) {
  if (!pool.has_weights()) return pool.information(index) * v;
  Eigen::MatrixXd result = v;
  for (Eigen::Index r = 0; r < v.rows(); ++r)
    result.row(r) *= pool.weight(index, static_cast<int>(r));
  return result;
}

inline double weighted_square(const EdgePool& pool, int index, const Eigen::VectorXd& e) {
  return e.dot(weighted(pool, index, e).col(0));
}

}  // namespace locograph
