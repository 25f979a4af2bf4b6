#pragma once
/// The least wrenches with which contacts hold a robot, each weighed by what it can bear.
///
///     LeastWrenches least(robot, counted, 1.0);             // with_margin() of what bears
///     dynamics.inverse_dynamics(state, velocity, acceleration, {}, asked);
///     if (least.solve(state, asked)) feed_forward = least.wrenches();
///
/// The unknowns are the rays of each contact (robots/bearing_rays.h): forces on the edges of
/// friction pyramids at the corners of areas, components of grasps. The cost is the sum of their
/// squares, each by the number of a contact's rays and the most that it bears: forces keep away
/// from the borders of cones and areas as long as they can, and what bears more carries more. The
/// constraints: the base's six rows, the least and the most of each contact, and, with torque
/// limits, the torques of joints. Strictly convex, so that the wrenches are continuous along a
/// motion whose accelerations are, as those of a linear programme, which lie in corners, are not.
///
/// Solved by solvers/dense_qp.h, from the active rows of the last solve. solve() does not allocate.
/// Thread-safety: one thread at a time. The robot must outlive it.

#include <locograph/plugins/configuration/execution_margin.h>
#include <locograph/robots/bearing_rays.h>
#include <locograph/robots/robot_state.h>
#include <locograph/solvers/dense_qp.h>

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace locograph {

class LeastWrenches {
 public:
  /// effort_scale: of the URDF's efforts, which limit torques; 0: no limits. Throws Error for
  /// contacts that all bear nothing.
  LeastWrenches(const Robot& robot, std::span<const BearingContact> contacts, double effort_scale);

  /// asked: of base and joints, as inverse dynamics gives it. Contacts act where the state has
  /// them. False: none hold, and wrenches() stays as it was.
  bool solve(const RobotState& state, const Eigen::VectorXd& asked);
  /// In the order of the contacts.
  const StanceWrenches& wrenches() const { return wrenches_; }

 private:
  struct Ray {
    std::size_t contact;
    Eigen::Vector3d at;             ///< from where the contact is, world
    Eigen::Vector3d force, moment;  ///< world
  };

  void place(const RobotState& state, std::size_t contact);

  const Robot& robot_;
  std::vector<BearingContact> contacts_;
  std::vector<int> links_;
  std::vector<Eigen::Matrix3d> axes_;      ///< of each contact, in its link or in the world
  std::vector<Eigen::Matrix3d> turned_;    ///< of what is fixed in the world, by balls on bars
  std::vector<Eigen::Vector3d> touching_;  ///< where each contact acts, world
  std::vector<Ray> rays_;
  double weight_N_;
  std::vector<int> joints_;  ///< whose torques are limited
  std::vector<double> efforts_Nm_;
  DenseQp qp_;
  Eigen::VectorXd torques_;
  StanceWrenches wrenches_;
};

/// At rest, with as much of the margin as there is. contacts: without a margin; effort_scale as
/// above, the margin's share of torques is taken of it. Nothing: none hold.
std::optional<StanceWrenches> wrenches_at_rest(const RobotState& state,
                                               std::span<const BearingContact> contacts,
                                               const ExecutionMargin& margin, double effort_scale);

}  // namespace locograph
