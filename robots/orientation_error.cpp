#include <locograph/common/skew.h>
#include <locograph/robots/orientation_error.h>

#include <Eigen/Geometry>
#include <cmath>

namespace locograph {

Eigen::Matrix3d inverse_right_jacobian(const Eigen::Vector3d& v) {
  const double squared = v.squaredNorm(), angle = std::sqrt(squared);
  // (1 − (θ/2) cot(θ/2)) / θ², and its series near zero.
  const double factor = angle < 1e-4 ? 1.0 / 12.0 + squared / 720.0
                                     : (1.0 - 0.5 * angle / std::tan(0.5 * angle)) / squared;
  const Eigen::Matrix3d cross = skew(v);
  return Eigen::Matrix3d::Identity() + 0.5 * cross + factor * cross * cross;
}

OrientationError::OrientationError(const Eigen::Matrix3d& world_from_target,
                                   const Eigen::Matrix3d& world_from_frame)
    : target_from_world_(world_from_target.transpose()) {
  const Eigen::Matrix3d target_from_frame = target_from_world_ * world_from_frame;
  const Eigen::AngleAxisd rotation(target_from_frame);
  vector = rotation.angle() * rotation.axis();
}

// log(exp(δ) R) ≈ log R + J_l⁻¹ δ with δ in the target's axes, and J_l⁻¹(v) = J_r⁻¹(−v).
Eigen::Matrix3d OrientationError::derivative() const {
  return inverse_right_jacobian(-vector) * target_from_world_;
}

namespace {
/// Below, an axis that points backwards has no direction to turn that rounding did not choose.
constexpr double kBackwards = 1e-9;
}  // namespace

TiltError::TiltError(const Eigen::Matrix3d& world_from_target,
                     const Eigen::Matrix3d& world_from_frame, int axis)
    : target_from_world_(world_from_target.transpose()), axis_(axis) {
  direction_.noalias() = target_from_world_ * world_from_frame.col(axis);
  cross_ = Eigen::Vector3d::Unit(axis).cross(direction_);
  sine_ = cross_.norm();
  const double angle = std::atan2(sine_, direction_[axis]);
  angle_per_sine_ = sine_ < 1e-3 && direction_[axis] > 0.0 ? 1.0 + sine_ * sine_ / 6.0
                                                           : angle / std::max(sine_, kBackwards);
  vector = angle_per_sine_ * cross_;
  if (sine_ < kBackwards && direction_[axis] < 0.0) {
    vector = angle * Eigen::Vector3d::Unit((axis + 1) % 3);
  }
}

// With a the axis, c its component along the target's axis e, u = e × a, s = |u|, k = θ / s:
// turning by ω moves a by ω × a, hence du = c ω − a (e·ω), dc = −u·ω,
// dk = −(1 − k c) / s² dc, and the vector k u by [k (c I − a eᵀ) + (1 − k c) / s² u uᵀ] ω.
Eigen::Matrix3d TiltError::derivative() const {
  const double c = direction_[axis_], k = angle_per_sine_, squared = sine_ * sine_;
  if (sine_ < kBackwards && c < 0.0) {
    const Eigen::Vector3d about = Eigen::Vector3d::Unit((axis_ + 1) % 3);
    return about * (about.transpose() * target_from_world_);
  }
  const double bend =
      sine_ < 1e-3 && c > 0.0 ? 1.0 / 3.0 + squared * 2.0 / 15.0 : (1.0 - k * c) / squared;
  Eigen::Matrix3d by_rotation = bend * cross_ * cross_.transpose();
  by_rotation.diagonal().array() += k * c;
  by_rotation.col(axis_) -= k * direction_;
  return by_rotation * target_from_world_;
}

}  // namespace locograph
