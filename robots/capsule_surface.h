#pragma once
/// Points spread evenly over the surface of a capsule.
///
///     visit_surface<200>(capsule, [&](const Eigen::Vector3d& point) {
///       worst = std::max(worst, mesh.distance_outside(point));
///     });

#include <locograph/robots/capsule.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

namespace locograph {

/// A Fibonacci lattice on the unit sphere.
template <int n>
const std::array<Eigen::Vector3d, n>& spread_directions() {
  static const std::array<Eigen::Vector3d, n> kDirections = [] {
    std::array<Eigen::Vector3d, n> directions;
    for (int i = 0; i < n; ++i) {
      const double z = 1.0 - (2.0 * i + 1.0) / n;
      const double angle = std::numbers::pi * (3.0 - std::sqrt(5.0)) * i;
      const double r = std::sqrt(1.0 - z * z);
      directions[static_cast<std::size_t>(i)] =
          Eigen::Vector3d(r * std::cos(angle), r * std::sin(angle), z);
    }
    return directions;
  }();
  return kDirections;
}

/// `n` points of the two ends, and rings of n / 6 along the cylinder between them.
template <int n, class Look>
void visit_surface(const Capsule& capsule, const Look& look) {
  const Eigen::Vector3d along = capsule.to - capsule.from;
  for (const Eigen::Vector3d& direction : spread_directions<n>()) {
    look(Eigen::Vector3d((direction.dot(along) > 0.0 ? capsule.to : capsule.from) +
                         capsule.radius * direction));
  }
  const double length = along.norm();
  if (!(length > 1e-3 * capsule.radius)) return;
  constexpr int kAround = n / 6;
  constexpr double kMostRings = n / 6;
  const double spacing = 2.0 * std::numbers::pi * capsule.radius / kAround;
  const int rings = 1 + static_cast<int>(std::min(kMostRings, length / std::max(spacing, 1e-9)));
  const Eigen::Vector3d u = along.unitOrthogonal(), v = along.cross(u) / length;
  for (int k = 0; k < kAround; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kAround;
    const Eigen::Vector3d arm = capsule.radius * (std::cos(angle) * u + std::sin(angle) * v);
    for (int i = 0; i < rings; ++i) {
      look(Eigen::Vector3d(capsule.from + (i + 0.5) / rings * along + arm));
    }
  }
}

}  // namespace locograph
