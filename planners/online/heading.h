#pragma once
/// Directions beside a robot's heading.
///
///     const double to_the_left_m = moved.dot(left_of(planned[3].data()));

#include <Eigen/Core>

namespace locograph {

/// Horizontal unit vector to the left of a configuration's heading, in the world.
Eigen::Vector3d left_of(const double* configuration);

/// The configuration with its base turned about the vertical, counter-clockwise.
Eigen::VectorXd turned(const Eigen::VectorXd& configuration, double yaw_rad);

}  // namespace locograph
