#pragma once
/// A path through waypoints that is twice continuously differentiable.
///
///     locograph::PathSpline path(robot, waypoints, Eigen::VectorXd::Ones(robot.tangent_size()));
///     PathPoint point;
///     path.at(0.5 * path.length(), point);   // configuration, first and second derivative
///
/// Base position, quaternion and joints are cubic splines over s, which goes by the distance
/// between waypoints; the quaternion is normalised where it is looked at. At the second waypoint
/// and the last but one even the third derivative is continuous ("not a knot"), so that waypoints h
/// apart on a smooth curve leave it by no more than O(h^4), at the ends as well. Two waypoints make
/// the straight path that the judge takes between two configurations, three a parabola. With Q the
/// quaternion of the spline, not normalised, and R its rotation, the base turns and moves in its
/// own axes by
///   omega = 2 vec(Q* Q') / |Q|^2,   omega' = 2 vec(Q* Q'') / |Q|^2 - 2 omega (Q . Q') / |Q|^2,
///   v = R^T p',                     v' = R^T p'' - omega x v,
/// as vec(Q'* Q') = 0 and a real part of Q* Q' only lengthens Q.

#include <locograph/robots/robot.h>

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace locograph {

struct PathPoint {
  double s = 0.0;
  Eigen::VectorXd configuration;
  Eigen::VectorXd first;   ///< d/ds, a tangent at the configuration
  Eigen::VectorXd second;  ///< derivative of `first`: as velocities in the base's own axes change
};

class PathSpline {
 public:
  /// scale: by tangent coordinate, > 0; s grows between waypoints by |difference / scale|. The path
  /// keeps within max_deviation of the straight way between waypoints: each joint [rad or m], the
  /// base [m] and its rotation [rad], that 1 rad at any rate; waypoints half-way are added until it
  /// does. Throws Error for
  /// fewer than two waypoints, for two in a row that are equal, and for numbers that make no sense.
  PathSpline(const Robot& robot, std::vector<Eigen::VectorXd> waypoints, Eigen::VectorXd scale,
             double max_deviation = std::numeric_limits<double>::infinity());

  double length() const { return knots_.back(); }
  /// s at the waypoints, those added included; between them all derivatives are continuous.
  const std::vector<double>& knots() const { return knots_; }
  /// How far the base turns from a knot to the next, the short way.
  double turn_rad(std::size_t knot) const;
  /// s is clamped to [0, length()].
  void at(double s, PathPoint& point) const;
  const Robot& robot() const { return *robot_; }

 private:
  void place_knots();
  void solve();
  bool add_waypoints(double max_deviation);
  bool deviates(std::size_t segment, double most) const;

  const Robot* robot_;
  Eigen::VectorXd scale_;
  std::vector<Eigen::VectorXd> waypoints_;  // quaternions of one sign
  std::vector<Eigen::VectorXd> bends_;      // second derivatives at the knots
  std::vector<double> knots_;
};

}  // namespace locograph
