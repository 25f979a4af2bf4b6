#pragma once
/// A signed distance and its gradient at one point.
///
///     locograph::DistanceSample s = field.sample(point);
///     double error = std::max(0.0, margin_m - s.distance);  // its derivative: -s.gradient

#include <Eigen/Core>

namespace locograph {

struct DistanceSample {
  double distance = 0.0;                               ///< [m], negative inside the obstacle
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< d distance / d point, world axes
};

}  // namespace locograph
