#pragma once
/// The nearest configuration in which contacts are closed.
///
///     ContactProjection contacts(robot);
///     contacts.set(stance.contacts, balls);
///     if (!contacts.project(q)) throw Error("the contacts do not close");
///
/// Nearest by the robot's tangent (robots/robot.h), each coordinate alike: Newton's steps of least
/// norm, -Jᵀ(J Jᵀ)⁺ e. Balls roll from where they are said to be (robots/rolling_ball.h).

#include <locograph/planners/posture/transition_problem.h>
#include <locograph/robots/contact_closure.h>

#include <Eigen/Core>
#include <span>
#include <vector>

namespace locograph {

class ContactProjection {
 public:
  /// The robot must outlive it. Closes nothing.
  explicit ContactProjection(const Robot& robot) : state_(robot) {}

  /// balls: one for each contact, from where it rolls; nothing: the contact is closed at its place.
  /// Throws Error for contacts that are not sound.
  void set(std::span<const Contact> contacts, const HeldBalls& balls);

  const Robot& robot() const { return state_.robot(); }
  int rows() const { return rows_; }
  /// Closure of a configuration whose quaternion has norm 1 [m, rad].
  void closure(const Eigen::VectorXd& q, Eigen::VectorXd& error);
  /// The same with its Jacobian, rows() x tangent_size.
  void closure(const Eigen::VectorXd& q, Eigen::VectorXd& error, Eigen::MatrixXd& jacobian);
  /// Poses of links, of the last closure().
  const RobotState& state() const { return state_; }

  /// Moves q the shortest way to where the contacts are closed to 1e-9; false: not found.
  bool project(Eigen::VectorXd& q);

 private:
  RobotState state_;
  std::vector<ContactClosure> closures_;
  int rows_ = 0;
  Eigen::VectorXd error_;
  Eigen::MatrixXd jacobian_;
};

}  // namespace locograph
