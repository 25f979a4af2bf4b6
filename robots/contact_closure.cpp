#include <locograph/robots/contact_closure.h>
#include <locograph/robots/orientation_error.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace locograph {
namespace {

constexpr std::array<int, 6> kSurface = {0, 1, 2, 3, 4, 5};
constexpr std::array<int, 5> kRung = {0, 1, 2, 3, 5};
constexpr std::array<int, 4> kWheel = {0, 1, 2, 3};

/// The tilted axis of the end effector: the normal of a surface, the bar of a rung.
constexpr int kNormal = 2, kBar = 1;

/// Calls f with the error of orientation; a point and a wheel have none.
template <class F>
void with_orientation(ContactKind kind, bool free_yaw, const Eigen::Matrix3d& contact,
                      const Eigen::Matrix3d& effector, F&& f) {
  if (kind == ContactKind::kSurface) {
    if (free_yaw) return f(TiltError(contact, effector, kNormal));
    return f(OrientationError(contact, effector));
  }
  if (kind == ContactKind::kGrasp) return f(TiltError(contact, effector, kBar));
}

/// √(1 − tilt²), never so small that its derivative is not finite.
double upright(double tilt) { return std::sqrt(std::max(1e-12, 1.0 - tilt * tilt)); }

}  // namespace

ContactClosure::ContactClosure(const Robot& robot, const Contact& contact)
    : kind_(contact.effector.kind),
      free_yaw_(kind_ == ContactKind::kSurface && !contact.forward),
      locked_(contact.locked),
      point_in_link_(contact.effector.point),
      axes_(axes_in_world(contact)),
      place_(contact.position) {
  require_sound_contact(robot, contact);
  link_ = robot.link_index(contact.effector.link);
  if (kind_ == ContactKind::kSurface || kind_ == ContactKind::kGrasp) {
    link_from_axes_ = axes_in_link(contact.effector);
  } else if (kind_ == ContactKind::kPoint) {
    place_ += contact.effector.radius_m * axes_.col(2);
  } else {
    wheel_ = wheel_of(robot, contact.effector);
  }
}

std::span<const int> ContactClosure::held() const {
  switch (kind_) {
    case ContactKind::kSurface:
      return std::span<const int>(kSurface).first(free_yaw_ ? 5 : 6);
    case ContactKind::kPoint:
      return std::span<const int>(kSurface).first(3);
    case ContactKind::kGrasp:
      return kRung;
    case ContactKind::kWheel:
      break;
  }
  return std::span<const int>(kWheel).subspan(locked_ ? 0 : 2);
}

void ContactClosure::error(const RobotState& state, double* e) const {
  if (kind_ == ContactKind::kWheel) {
    const WheelPose pose(state, wheel_);
    const Eigen::Vector3d normal = axes_.col(2);
    const double tilt = normal.dot(pose.axle);
    for (int row = 0; locked_ && row < 2; ++row) *e++ = axes_.col(row).dot(pose.centre - place_);
    *e++ = normal.dot(pose.centre - place_) - wheel_.radius_m * upright(tilt);
    *e = tilt;
    return;
  }
  const Eigen::Isometry3d& world_from_link = state.world_from_link(link_);
  Eigen::Matrix<double, 6, 1> all;
  all.head<3>() = axes_.transpose() * (world_from_link * point_in_link_ - place_);
  const Eigen::Matrix3d effector = world_from_link.linear() * link_from_axes_;
  with_orientation(kind_, free_yaw_, axes_, effector,
                   [&](const auto& turned) { all.tail<3>() = turned.vector; });
  for (const int row : held()) *e++ = all[row];
}

void ContactClosure::add_jacobian(const RobotState& state, double* jacobian,
                                  std::ptrdiff_t stride) const {
  if (kind_ == ContactKind::kWheel) {
    const WheelPose pose(state, wheel_);
    const Eigen::Vector3d normal = axes_.col(2);
    const double tilt = normal.dot(pose.axle);
    for (int row = 0; locked_ && row < 2; ++row) {
      state.add_point_gradient(wheel_.carrier, pose.centre, axes_.col(row), 1.0, jacobian);
      jacobian += stride;
    }
    state.add_point_gradient(wheel_.carrier, pose.centre, normal, 1.0, jacobian);
    state.add_axis_gradient(wheel_.carrier, pose.axle, normal,
                            wheel_.radius_m * tilt / upright(tilt), jacobian);
    state.add_axis_gradient(wheel_.carrier, pose.axle, normal, 1.0, jacobian + stride);
    return;
  }
  const Eigen::Isometry3d& world_from_link = state.world_from_link(link_);
  const Eigen::Vector3d point = world_from_link * point_in_link_;
  const Eigen::Matrix3d effector = world_from_link.linear() * link_from_axes_;
  Eigen::Matrix3d turning = Eigen::Matrix3d::Zero();
  with_orientation(kind_, free_yaw_, axes_, effector,
                   [&](const auto& turned) { turning = turned.derivative(); });
  for (const int row : held()) {
    if (row < 3) {
      state.add_point_gradient(link_, point, axes_.col(row), 1.0, jacobian);
    } else {
      state.add_rotation_gradient(link_, turning.row(row - 3).transpose(), 1.0, jacobian);
    }
    jacobian += stride;
  }
}

}  // namespace locograph
