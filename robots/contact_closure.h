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
///   ball that rolled      3  its slip since another configuration along both directions of what it
///                            touches, its height above that [m] (rolling_ball.h)
///   rung                  5  c − p along x y z [m], tilt of the bar about x z [rad]
///   wheel                 2  height of the disc's lowest point above the plane,
///                            n · (c − p) − r √(1 − (n · a)²) [m]; n · a, the sine of the tilt of
///                            the axle a to the plane [1]
///   wheel, locked         4  c − p along x y [m], which is where an upright disc touches; then
///                            those of a wheel
///
/// For the tilt see orientation_error.h. The kind of the contact makes the rows
/// (contact_kinds.h); what is fixed is worked out by the constructor; error()
/// and add_jacobian() do not allocate. Const functions may be shared between threads.

#include <locograph/robots/contact.h>
#include <locograph/robots/robot_state.h>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace locograph {

/// The rows of one contact, as its kind has them.
class ClosureRows {
 public:
  virtual ~ClosureRows() = default;

  int rows() const { return static_cast<int>(held_.size()); }
  /// What each row holds: 0-2 position along the contact's axes, 3-5 rotation about them; of a
  /// wheel 2, its height, and 3, its tilt; of a locked one 0 and 1, too.
  std::span<const int> held() const { return held_; }
  /// Link whose movement opens and closes it; of a wheel, the one that carries it.
  int link() const { return link_; }
  /// What a row is called, where held() does not say it.
  virtual std::optional<ContactRowLabel> label(int row) const;

  /// e: rows() numbers.
  virtual void error(const RobotState& state, double* e) const = 0;
  /// jacobian: rows() rows of tangent_size numbers, one row after the other, `stride` apart. Adds
  /// to the columns of the base and of support(link()) only.
  virtual void add_jacobian(const RobotState& state, double* jacobian,
                            std::ptrdiff_t stride) const = 0;

 protected:
  ClosureRows(std::vector<int> held, int link) : held_(std::move(held)), link_(link) {}

 private:
  std::vector<int> held_;
  int link_;
};

struct BallPose;

/// The rows of a contact of any kind, as a value.
class ContactClosure {
 public:
  /// Closes nothing.
  ContactClosure() = default;
  /// Throws Error for an end effector that is not sound, or a place that is none.
  ContactClosure(const Robot& robot, const Contact& contact);
  /// Of a ball that rolls from there.
  ContactClosure(const Robot& robot, const Contact& contact, const BallPose& from);

  int rows() const { return static_cast<int>(held().size()); }
  std::span<const int> held() const { return rows_ ? rows_->held() : std::span<const int>(); }
  int link() const { return rows_ ? rows_->link() : -1; }
  std::optional<ContactRowLabel> label(int row) const { return rows_->label(row); }

  void error(const RobotState& state, double* e) const { rows_->error(state, e); }
  void add_jacobian(const RobotState& state, double* jacobian, std::ptrdiff_t stride) const {
    rows_->add_jacobian(state, jacobian, stride);
  }

 private:
  std::shared_ptr<const ClosureRows> rows_;
};

}  // namespace locograph
