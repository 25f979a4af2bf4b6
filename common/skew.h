#pragma once
/// The matrix of a cross product.
///
///     skew(v) * w;  // v × w

#include <Eigen/Core>

namespace locograph {

inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0;
  return m;
}

}  // namespace locograph
