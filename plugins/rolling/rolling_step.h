#pragma once
/// How a wheel moves and steers from one configuration to another: what edges on wheels share.
///
///     const WheelPose from(a.kinematics, wheel), to(b.kinematics, wheel);
///     const RollingStep step(from, to, normal);
///     const double slip = step.lateral;

#include <locograph/plugins/configuration/stance_parameter.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace locograph {

/// The part of a vector in the plane that the wheel rolls on.
inline Eigen::Vector3d rolling_part(const Eigen::Vector3d& v, const Eigen::Vector3d& normal) {
  return v - normal.dot(v) * normal;
}

/// The derivative of a number by the pose of a wheel's carrier: by the wheel's centre, and by how
/// it turns, in the world. That of a · v by a vector a of the carrier is a × v by how it turns.
struct WheelGradient {
  Eigen::Vector3d by_centre, by_turn;

  void add_to(const RobotState& kinematics, const Wheel& wheel, const WheelPose& pose,
              double* row) const {
    kinematics.add_wrench_gradient(wheel.carrier, pose.centre, by_centre, by_turn, row);
  }
};

/// What the two poses of a wheel have between them.
struct RollingStep {
  Eigen::Vector3d moved;     ///< of the centre, in the plane
  Eigen::Vector3d from, to;  ///< the axles' parts in the plane
  Eigen::Vector3d axle;      ///< midway between them, unit
  double length;             ///< of the sum of `from` and `to`; 0: opposite, they have no middle
  double sine, cosine;       ///< of the angle between them about the normal, times their lengths
  double lateral;            ///< moved · axle
  double way;                ///< moved · (axle × normal), along the mean heading

  RollingStep(const WheelPose& a, const WheelPose& b, const Eigen::Vector3d& normal)
      : moved(rolling_part(b.centre - a.centre, normal)),
        from(rolling_part(a.axle, normal)),
        to(rolling_part(b.axle, normal)) {
    const Eigen::Vector3d sum = from + to;
    length = sum.norm();
    constexpr double kOpposite = 1e-6;
    if (length < kOpposite) length = 0.0;
    axle = length > 0.0 ? Eigen::Vector3d(sum / length) : normal.cross(from).stableNormalized();
    sine = normal.dot(from.cross(to));
    cosine = from.dot(to);
    lateral = moved.dot(axle);
    way = moved.dot(axle.cross(normal));
  }

  /// The angle between the axles about the normal.
  double turned() const { return std::atan2(sine, cosine); }
  /// Its size is no larger: an angle is less than its tangent.
  double turned_at_most() const {
    return cosine > 0.0 ? std::abs(sine) / cosine : std::numbers::pi;
  }
  double beyond_quarter_turn() const {
    return cosine >= 0.0 ? 0.0 : std::max(0.0, std::abs(turned()) - 0.5 * std::numbers::pi);
  }

  /// The derivative of v · axle by either axle.
  Eigen::Vector3d by_axle(const Eigen::Vector3d& v) const {
    if (length == 0.0) return Eigen::Vector3d::Zero();
    return (v - axle.dot(v) * axle) / length;
  }
  /// d(way) by one pose of the wheel; sign: -1 for the first, 1 for the second.
  WheelGradient way_gradient(const WheelPose& pose, const Eigen::Vector3d& normal,
                             double sign) const {
    // moved · (axle × normal) = axle · (normal × moved)
    return {sign * axle.cross(normal), pose.axle.cross(by_axle(normal.cross(moved)))};
  }
};

/// dθ, θ the angle of the axle about the normal: a vector a in the plane turns by
/// (n × a) · da / |a|².
inline Eigen::Vector3d turn_gradient(const WheelPose& pose, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d flat = rolling_part(pose.axle, normal);
  return pose.axle.cross(normal.cross(flat)) / flat.squaredNorm();
}

}  // namespace locograph
