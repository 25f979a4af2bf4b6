#pragma once
/// Directions beside a robot's heading.
///
///     const double to_the_left_m = moved.dot(left_of(planned[3].data()));

#include <Eigen/Core>

namespace locograph {

/// Horizontal unit vector to the left of a configuration's heading, in the world.
Eigen::Vector3d left_of(const double* configuration);

/// Counter-clockwise, from the heading of one configuration to that of another one.
double turn_between(const double* from, const double* to);

/// Turns a configuration's base about the vertical, counter-clockwise.
void turn_base(double yaw_rad, double* configuration);

}  // namespace locograph
