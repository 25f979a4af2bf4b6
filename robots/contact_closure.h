#pragma once
/// How far a contact is from being closed, and how that changes with the configuration.
///
///     const ContactClosure closure(robot, contact);
///     Eigen::VectorXd e(closure.rows());
///     closure.error(state, e.data());
///     Matrix jacobian = Matrix::Zero(closure.rows(), robot.tangent_size());       // row-major
///     closure.add_jacobian(state, jacobian.data(), robot.tangent_size());
///
/// Rows, with C the contact's axes in the world, F those of the end effector (contact.h), p the
/// contact's place and c the end effector's point; along C:
///
///   kind                  n  rows
///   surface               6  c − p along x y z [m], rotation vector log(Cᵀ F) about x y z [rad]
///   surface, yaw is free  5  c − p along x y z [m], tilt of the normal about x y [rad]
///   point                 3  c − p − radius · normal along x y z [m]
///   rung                  5  c − p along x y z [m], tilt of the bar about x z [rad]
///   wheel                 2  height of the disc's lowest point above the plane,
///                            n · (c − p) − r √(1 − (n · a)²) [m]; n · a, the sine of the tilt of
///                            the axle a to the plane [1]
///   wheel, locked         4  c − p along x y [m], which is where an upright disc touches; then
///                            those of a wheel
///
/// For the tilt see orientation_error.h. What is fixed is worked out by the constructor; error()
/// and add_jacobian() do not allocate. Const functions may be shared between threads.

#include <locograph/robots/contact.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/wheel.h>

#include <Eigen/Geometry>

namespace locograph {

class ContactClosure {
 public:
  /// Closes nothing.
  ContactClosure() = default;
  /// Throws Error for an end effector that is not sound, or a place that is none.
  ContactClosure(const Robot& robot, const Contact& contact);

  int rows() const { return static_cast<int>(held().size()); }
  /// What each row holds: 0-2 position along the contact's axes, 3-5 rotation about them; of a
  /// wheel 2, its height, and 3, its tilt; of a locked one 0 and 1, too.
  std::span<const int> held() const;
  /// Link whose movement opens and closes it; of a wheel, the one that carries it.
  int link() const { return kind_ == ContactKind::kWheel ? wheel_.carrier : link_; }

  /// e: rows() numbers.
  void error(const RobotState& state, double* e) const;
  /// jacobian: rows() rows of tangent_size numbers, one row behind the other, `stride` apart. Adds
  /// to the columns of the base and of support(link()) only.
  void add_jacobian(const RobotState& state, double* jacobian, std::ptrdiff_t stride) const;

 private:
  ContactKind kind_ = ContactKind::kPoint;
  bool free_yaw_ = false;
  bool locked_ = false;
  int link_ = -1;
  Eigen::Vector3d point_in_link_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d link_from_axes_ = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  ///< in the world
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();     ///< where the point belongs, world
  Wheel wheel_;
};

}  // namespace locograph
