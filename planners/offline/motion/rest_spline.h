#pragma once
/// Slopes with which a motion from rest to rest has no jumps of acceleration.
///
///     rest_spline(robot, 0.02, configurations, slopes);
///
/// Slopes at vertices that are equally far apart in time are those of the cubic spline, so that the
/// curve of check/motion_curve.h has continuous accelerations: forces that carry the robot need not
/// jump. At both ends it is at rest and does not accelerate either, which a spline with free slopes
/// has no room for: the second vertex and the last but one are moved along the way by what that
/// takes, in steps of 20 ms by less than a micrometre or so. With d_i from vertex i to the next and
/// x_1 = x_0 + h m_1 / 3, as a curve that begins with t^3 has it:
///   4 m_1 + m_2 = 3 (d_0 + d_1) / h,   2 m_1 + 4 m_2 + m_3 = 3 (d_0 + d_1 + d_2) / h,
///   m_{i-1} + 4 m_i + m_{i+1} = 3 (d_{i-1} + d_i) / h   further in.
/// The base's rotation does not add up like that: what is left of its jumps is taken out once more.

#include <locograph/robots/robot.h>

#include <Eigen/Core>
#include <vector>

namespace locograph {

/// Fewer configurations have too little room.
inline constexpr std::size_t kLeastOfRestSpline = 7;

/// configurations: kLeastOfRestSpline or more. slopes: as Motion::slopes, overwritten.
void rest_spline(const Robot& robot, double step_s, std::vector<Eigen::VectorXd>& configurations,
                 std::vector<Eigen::VectorXd>& slopes);

}  // namespace locograph
