#pragma once
/// How far a point is from where the distance to the world has a kink.
///
///     if (kink_distance(obstacle, point, time_s) < 0.01) return;  // numeric differences notice

#include <locograph/world/distance_field.h>
#include <locograph/world/obstacles.h>

#include <algorithm>
#include <cmath>

namespace locograph::test {

/// Distance from a kink of the distance to an obstacle: where another of its faces or edges becomes
/// the nearest. (On some of these only the curvature jumps; differences notice that, too.)
inline double kink_distance(const Obstacle& obstacle, const Eigen::Vector3d& point, double time_s) {
  const Eigen::Vector3d local = obstacle.pose_at(time_s).inverse() * point;
  switch (obstacle.shape) {
    case Obstacle::Shape::kSphere:
      return local.norm();
    case Obstacle::Shape::kBox: {
      Eigen::Vector3d excess = local.cwiseAbs() - 0.5 * obstacle.size;
      double nearest = std::min(excess.cwiseAbs().minCoeff(), local.cwiseAbs().minCoeff());
      std::sort(excess.data(), excess.data() + 3);
      return std::min({nearest, excess[2] - excess[1]});
    }
    case Obstacle::Shape::kCylinder: {
      const double rho = std::hypot(local.x(), local.y());
      const double radial = rho - obstacle.size[0];
      const double axial = std::abs(local.z()) - 0.5 * obstacle.size[1];
      return std::min(
          {rho, std::abs(local.z()), std::abs(radial), std::abs(axial), std::abs(radial - axial)});
    }
  }
  return 0.0;
}

inline double kink_distance(const DistanceField& field, const Eigen::Vector3d& point) {
  double nearest = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = (point[axis] - field.lower()[axis]) / field.resolution();
    nearest = std::min(nearest, std::abs(cell - std::round(cell)) * field.resolution());
  }
  return nearest;
}

}  // namespace locograph::test
