#include <locograph/robots/frame_closure.h>
#include <locograph/robots/orientation_error.h>

namespace locograph {
namespace {

using Held = FrameClosure::Held;

std::vector<int> rows_held(Held what) {
  switch (what) {
    case Held::kPosition:
      return {0, 1, 2};
    case Held::kTiltOfY:
      return {0, 1, 2, 3, 5};
    case Held::kTiltOfZ:
      return {0, 1, 2, 3, 4};
    case Held::kOrientation:
      break;
  }
  return {0, 1, 2, 3, 4, 5};
}

/// Calls f with the error of orientation, if it is held.
template <class F>
void with_orientation(Held what, const Eigen::Matrix3d& contact, const Eigen::Matrix3d& effector,
                      F&& f) {
  if (what == Held::kOrientation) return f(OrientationError(contact, effector));
  if (what == Held::kTiltOfZ) return f(TiltError(contact, effector, 2));
  if (what == Held::kTiltOfY) return f(TiltError(contact, effector, 1));
}

}  // namespace

FrameClosure::FrameClosure(const Robot& robot, const Contact& contact, const Eigen::Vector3d& place,
                           Held what)
    : ClosureRows(rows_held(what), robot.link_index(contact.effector.link)),
      what_(what),
      point_in_link_(contact.effector.point),
      axes_(axes_in_world(contact)),
      place_(place) {
  if (what != Held::kPosition) link_from_axes_ = axes_in_link(contact.effector);
}

void FrameClosure::error(const RobotState& state, double* e) const {
  const Eigen::Isometry3d& world_from_link = state.world_from_link(link());
  Eigen::Matrix<double, 6, 1> all;
  all.head<3>() = axes_.transpose() * (world_from_link * point_in_link_ - place_);
  const Eigen::Matrix3d effector = world_from_link.linear() * link_from_axes_;
  with_orientation(what_, axes_, effector,
                   [&](const auto& turned) { all.tail<3>() = turned.vector; });
  for (const int row : held()) *e++ = all[row];
}

void FrameClosure::add_jacobian(const RobotState& state, double* jacobian,
                                std::ptrdiff_t stride) const {
  const Eigen::Isometry3d& world_from_link = state.world_from_link(link());
  const Eigen::Vector3d point = world_from_link * point_in_link_;
  const Eigen::Matrix3d effector = world_from_link.linear() * link_from_axes_;
  Eigen::Matrix3d turning = Eigen::Matrix3d::Zero();
  with_orientation(what_, axes_, effector,
                   [&](const auto& turned) { turning = turned.derivative(); });
  for (const int row : held()) {
    if (row < 3) {
      state.add_point_gradient(link(), point, axes_.col(row), 1.0, jacobian);
    } else {
      state.add_rotation_gradient(link(), turning.row(row - 3).transpose(), 1.0, jacobian);
    }
    jacobian += stride;
  }
}

}  // namespace locograph
