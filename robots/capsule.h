#pragma once
/// Everything within `radius` of a segment; a sphere where from = to.
///
///     const Capsule capsule{{0, 0, 0}, {0, 0, 0.3}, 0.05};
///     bool inside = signed_distance(capsule, point) <= 0.0;

#include <Eigen/Core>
#include <algorithm>

namespace locograph {

struct Capsule {
  Eigen::Vector3d from, to;  ///< m
  double radius;             ///< m
};

/// On radii and distances: covers points on the surface up to rounding.
inline constexpr double kInflation = 1.0 + 1e-9;

inline double distance_to_axis(const Capsule& capsule, const Eigen::Vector3d& point) {
  const Eigen::Vector3d along = capsule.to - capsule.from, arm = point - capsule.from;
  const double squared = along.squaredNorm();
  const double t = squared > 0.0 ? std::clamp(arm.dot(along) / squared, 0.0, 1.0) : 0.0;
  return (arm - t * along).norm();
}

inline double signed_distance(const Capsule& capsule, const Eigen::Vector3d& point) {
  return distance_to_axis(capsule, point) - capsule.radius;
}

}  // namespace locograph
