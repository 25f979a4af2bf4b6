#pragma once
/// How a ball that is held rolls: its skin does not slip on what it touches, so that its centre
/// moves as its link turns.
///
///     const BallTrack track(contact);                            // is_ball(contact.effector)
///     const BallPose before(state, contact.effector);
///     state.update(next.data());
///     const BallStep step(track, before, {state, contact.effector});
///     const double slip_m = step.error.head<2>().norm(), height_m = step.error[2];
///
/// With c the centre, w the angular velocity of the link, r the radius and n the normal of what is
/// touched, c' = w × r n. A step is the shortest turn θ = log(R_to R_fromᵀ), about a constant axis.
/// On a plane with the axes x, y, n
///
///   slip  x · Δc − r θ · y,  y · Δc + r θ · x;       height  n · (c_to − p) − r
///
/// On a bar of radius R about the axis a the normal goes along: it turns about a by
/// Φ = r θ · a / (R + r). With b = a × n where the step begins, ρ the distance of the centre to the
/// axis, α the angle about a from there to where it ends
///
///   slip  a · Δc − r ∫ (θ × n) · a = a · Δc + r (θ · b sin Φ / Φ − θ · n (1 − cos Φ) / Φ),
///         (R + r) α − r θ · a;                        height  ρ_to − (R + r)
///
/// Turning about the normal is free. Nothing here allocates.

#include <locograph/robots/bearing_rays.h>
#include <locograph/robots/robot_state.h>

#include <Eigen/Core>
#include <span>
#include <vector>

namespace locograph {

/// A point contact with a radius.
bool is_ball(const EndEffector& effector);

/// Where a ball is: the rotation of its link and its centre [m], in the world.
struct BallPose {
  BallPose(const RobotState& state, const EndEffector& ball);
  BallPose(const Eigen::Isometry3d& world_from_link, const Eigen::Vector3d& point_in_link);

  Eigen::Matrix3d world_from_link;
  Eigen::Vector3d centre;
};

/// What a ball rolls on, from its contact.
class BallTrack {
 public:
  /// The contact must be sound, and of a ball.
  explicit BallTrack(const Contact& contact);

  double radius_m() const { return radius_m_; }
  bool is_round() const { return bar_radius_m_ > 0.0; }
  /// Of the plane, or of the bar on the side of the centre.
  Eigen::Vector3d normal(const Eigen::Vector3d& centre) const;
  /// Of a bar: direction of its axis; how the normal turns about it as the centre moves [rad/m].
  Eigen::Vector3d axis() const { return axes_.col(0); }
  Eigen::Vector3d turn_per_metre(const Eigen::Vector3d& centre) const;
  /// The point that touches.
  Eigen::Vector3d touching(const Eigen::Vector3d& centre) const {
    return centre - radius_m_ * normal(centre);
  }
  /// The pose with its centre moved along the track, as slips are measured.
  BallPose moved(const BallPose& pose, const Eigen::Vector2d& by_m) const;

 private:
  friend class BallStep;

  /// From the axis of the bar, across it.
  Eigen::Vector3d from_axis(const Eigen::Vector3d& centre) const;

  double radius_m_, bar_radius_m_ = 0.0;  ///< 0: a plane
  Eigen::Vector3d place_;                 ///< on the plane, or on the axis of the bar
  /// Columns x, y and the normal of the plane; of a bar, x is its axis.
  Eigen::Matrix3d axes_;
};

/// From one pose to another.
class BallStep {
 public:
  BallStep(const BallTrack& track, const BallPose& from, const BallPose& to);

  Eigen::Vector3d error;  ///< slip along both directions of the track, height where it ends [m]

  struct Derivative {
    Eigen::Matrix3d by_centre, by_turn;  ///< rows of the error; turn: a rotation in the world
  };
  Derivative by_to() const;
  Derivative by_from() const;

 private:
  const BallTrack& track_;
  Eigen::Vector3d turn_;
  /// On a bar, at both ends: normal, across it, distance to the axis.
  Eigen::Vector3d normal_from_, across_from_, normal_to_, across_to_;
  double distance_from_ = 0.0, distance_to_ = 0.0;
  Eigen::Matrix3d by_turn_;  ///< of the error by θ
};

/// The contact at the place that its ball has rolled to; others as they are.
Contact rolled_to(const RobotState& state, const Contact& contact);
std::vector<BearingContact> rolled_to(const RobotState& state,
                                      std::span<const BearingContact> contacts);

}  // namespace locograph
