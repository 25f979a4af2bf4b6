#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/orientation_error.h>
#include <locograph/robots/rolling_ball.h>

#include <Eigen/Geometry>
#include <cmath>

namespace locograph {
namespace {

Eigen::Vector3d shortest_turn(const Eigen::Matrix3d& from, const Eigen::Matrix3d& to) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(to * from.transpose()));
  return turn.angle() * turn.axis();
}

/// sin Φ / Φ and (1 − cos Φ) / Φ with their derivatives.
struct TurnIntegrals {
  double sine, cosine, sine_slope, cosine_slope;

  explicit TurnIntegrals(double angle) {
    const double squared = angle * angle;
    if (squared < 1e-4) {  // series, whose next terms are below 1e-14
      sine = 1.0 - squared / 6.0 * (1.0 - squared / 20.0);
      cosine = angle * (0.5 - squared / 24.0 * (1.0 - squared / 30.0));
      sine_slope = -angle / 3.0 * (1.0 - squared / 10.0 * (1.0 - squared / 28.0));
      cosine_slope = 0.5 - squared / 8.0 * (1.0 - squared / 18.0);
      return;
    }
    sine = std::sin(angle) / angle;
    cosine = (1.0 - std::cos(angle)) / angle;
    sine_slope = (std::cos(angle) - sine) / angle;
    cosine_slope = (std::sin(angle) - cosine) / angle;
  }
};

}  // namespace

bool is_ball(const EndEffector& effector) {
  const ContactKindEntry& kind = contact_kind_entry(effector.kind);
  return kind.turns_freely && kind.is_round() && effector.radius_m > 0.0;
}

BallPose::BallPose(const RobotState& state, const EndEffector& ball)
    : BallPose(state.world_from_link(state.robot().link_index(ball.link)), ball.point) {}

BallPose::BallPose(const Eigen::Isometry3d& pose, const Eigen::Vector3d& point_in_link)
    : world_from_link(pose.linear()), centre(pose * point_in_link) {}

BallTrack::BallTrack(const Contact& contact)
    : radius_m_(contact.effector.radius_m),
      place_(contact.position),
      axes_(axes_in_world(contact)) {
  if (!contact.bar) return;
  bar_radius_m_ = contact.bar->radius_m;
  place_ -= bar_radius_m_ * axes_.col(2);
  axes_.col(0) = contact.bar->axis.stableNormalized();
}

Eigen::Vector3d BallTrack::from_axis(const Eigen::Vector3d& centre) const {
  const Eigen::Vector3d off = centre - place_;
  return off - axes_.col(0) * axes_.col(0).dot(off);
}

Eigen::Vector3d BallTrack::normal(const Eigen::Vector3d& centre) const {
  return is_round() ? Eigen::Vector3d(from_axis(centre).normalized()) : axes_.col(2);
}

Eigen::Vector3d BallTrack::turn_per_metre(const Eigen::Vector3d& centre) const {
  const Eigen::Vector3d off = from_axis(centre);
  return axis().cross(off) / off.squaredNorm();
}

BallPose BallTrack::moved(const BallPose& pose, const Eigen::Vector2d& by_m) const {
  BallPose result = pose;
  if (!is_round()) {
    result.centre += axes_.leftCols<2>() * by_m;
    return result;
  }
  const Eigen::AngleAxisd round(by_m.y() / (bar_radius_m_ + radius_m_), axes_.col(0));
  const Eigen::Vector3d off = from_axis(pose.centre);
  result.centre += round * off - off + by_m.x() * axes_.col(0);
  return result;
}

BallStep::BallStep(const BallTrack& track, const BallPose& from, const BallPose& to)
    : track_(track), turn_(shortest_turn(from.world_from_link, to.world_from_link)) {
  const double r = track.radius_m_;
  const Eigen::Matrix3d& axes = track.axes_;
  const Eigen::Vector3d moved = to.centre - from.centre;
  if (!track.is_round()) {
    by_turn_.row(0) = -r * axes.col(1);
    by_turn_.row(1) = r * axes.col(0);
    by_turn_.row(2).setZero();
    error = axes.transpose() * moved;
    error[2] = axes.col(2).dot(to.centre - track.place_) - r;
    error += by_turn_ * turn_;
    return;
  }
  const auto axis = axes.col(0);
  const double reach = track.bar_radius_m_ + r;
  const auto look = [&](const Eigen::Vector3d& centre, Eigen::Vector3d& normal,
                        Eigen::Vector3d& across, double& distance) {
    const Eigen::Vector3d off = track.from_axis(centre);
    distance = off.norm();
    normal = off / distance;
    across = axis.cross(normal);
  };
  look(from.centre, normal_from_, across_from_, distance_from_);
  look(to.centre, normal_to_, across_to_, distance_to_);
  const double share = r / reach, about = turn_.dot(axis);
  const TurnIntegrals integrals(share * about);
  const double across = turn_.dot(across_from_), along = turn_.dot(normal_from_);
  const double round = std::atan2(across_from_.dot(normal_to_), normal_from_.dot(normal_to_));
  error << axis.dot(moved) + r * (across * integrals.sine - along * integrals.cosine),
      reach * round - r * about, distance_to_ - reach;
  by_turn_.row(0) =
      r * (integrals.sine * across_from_ - integrals.cosine * normal_from_ +
           share * (across * integrals.sine_slope - along * integrals.cosine_slope) * axis);
  by_turn_.row(1) = -r * axis;
  by_turn_.row(2).setZero();
}

BallStep::Derivative BallStep::by_to() const {
  Derivative result;
  // log(exp(δ) exp(θ)) ≈ θ + J δ with the inverse of the left Jacobian, the right one's transposed.
  result.by_turn = by_turn_ * inverse_right_jacobian(turn_).transpose();
  if (track_.is_round()) {
    const double reach = track_.bar_radius_m_ + track_.radius_m_;
    result.by_centre.row(0) = track_.axes_.col(0);
    result.by_centre.row(1) = reach / distance_to_ * across_to_;
    result.by_centre.row(2) = normal_to_;
  } else {
    result.by_centre = track_.axes_.transpose();
  }
  return result;
}

BallStep::Derivative BallStep::by_from() const {
  Derivative result;
  result.by_turn = -by_turn_ * inverse_right_jacobian(turn_);
  if (track_.is_round()) {
    const double r = track_.radius_m_, reach = track_.bar_radius_m_ + r;
    const TurnIntegrals integrals(r / reach * turn_.dot(track_.axes_.col(0)));
    // Where it begins further round, the normal turns towards b, and b back towards the normal.
    const double further = -r * (turn_.dot(normal_from_) * integrals.sine +
                                 turn_.dot(across_from_) * integrals.cosine);
    result.by_centre.row(0) = -track_.axes_.col(0) + further / distance_from_ * across_from_;
    result.by_centre.row(1) = -reach / distance_from_ * across_from_;
  } else {
    result.by_centre = -track_.axes_.transpose();
  }
  result.by_centre.row(2).setZero();
  return result;
}

Contact rolled_to(const RobotState& state, const Contact& contact) {
  if (!is_ball(contact.effector)) return contact;
  const BallTrack track(contact);
  const BallPose pose(state, contact.effector);
  Contact there = contact;
  there.position = track.touching(pose.centre);
  if (track.is_round()) there.normal = track.normal(pose.centre);
  return there;
}

std::vector<BearingContact> rolled_to(const RobotState& state,
                                      std::span<const BearingContact> contacts) {
  std::vector<BearingContact> there(contacts.begin(), contacts.end());
  for (BearingContact& one : there) one.contact = rolled_to(state, one.contact);
  return there;
}

}  // namespace locograph
