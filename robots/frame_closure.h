#pragma once
/// The rows of a frame on a link that a contact holds: its position, and of its orientation all,
/// the tilt of one axis, or nothing.
///
///     const FrameClosure grasp(robot, contact, contact.position, FrameClosure::Held::kTiltOfY);
///     const bool holds_the_bar = grasp.rows() == 5;

#include <locograph/robots/contact_closure.h>

namespace locograph {

class FrameClosure final : public ClosureRows {
 public:
  enum class Held { kPosition, kTiltOfY, kTiltOfZ, kOrientation };

  /// place: where the end effector's point belongs [m], world.
  FrameClosure(const Robot& robot, const Contact& contact, const Eigen::Vector3d& place, Held what);

  void error(const RobotState& state, double* e) const override;
  void add_jacobian(const RobotState& state, double* jacobian,
                    std::ptrdiff_t stride) const override;

 private:
  Held what_;
  Eigen::Vector3d point_in_link_;
  Eigen::Matrix3d link_from_axes_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d axes_;   ///< in the world
  Eigen::Vector3d place_;  ///< where the point belongs, world
};

}  // namespace locograph
