#pragma once
/// The least share of their limits that joints need for contacts to balance a robot, and how it
/// changes with the configuration.
///
///     TorqueProgramme programme(robot, bearing, 1.0, 0.1);
///     const double share = programme.solve(state, gradient);      // above 1: too heavy
///
/// A linear programme over the forces at the contacts (the rays of balance_region.h): the least t
/// with equilibrium of the base, forces inside friction pyramids and limits, and |torque| <= t
/// limit at every joint. By the envelope theorem its gradient is that of the torques with the
/// optimal forces held, weighted by the dual variables.

#include <locograph/planners/balance/balance_region.h>
#include <locograph/planners/balance/linear_programme.h>
#include <locograph/robots/rolling_ball.h>
#include <locograph/robots/statics.h>

#include <Eigen/Core>
#include <span>
#include <vector>

namespace locograph {

class TorqueProgramme {
 public:
  /// margin: the part of friction, areas and limits of force that is left unused.
  TorqueProgramme(const Robot& robot, std::span<const BearingContact> contacts, double effort_scale,
                  double margin);

  /// gradient: tangent_size numbers, overwritten. Infinity, and no gradient, where nothing
  /// balances.
  double solve(const RobotState& state, Eigen::VectorXd& gradient);
  /// The joint that needs most of its limit, of the last solve.
  int heaviest_joint() const { return heaviest_; }

 private:
  /// One ray of a pyramid, or one component of a grasp: force and moment in the world [parts of the
  /// robot's weight].
  struct Ray {
    int contact;
    Eigen::Vector3d at;  ///< from the contact's position, world
    Eigen::Vector3d force, moment;
    double lower, upper;
  };
  void add(const BearingContact& bearing, double margin);

  const Robot& robot_;
  double weight_N_, effort_scale_;
  std::vector<int> links_;
  std::vector<Eigen::Vector3d> positions_;  ///< of balls, of the last solve
  /// A ball and its contact.
  struct Ball {
    std::size_t contact;
    EndEffector effector;
    BallTrack track;
  };
  std::vector<Ball> balls_;
  std::vector<double> most_;   ///< pressing force of each contact; negative: no such limit
  std::vector<double> least_;  ///< of each contact; 0: none
  std::vector<Ray> rays_;
  std::vector<int> joints_;  ///< with a limit
  Eigen::MatrixXd columns_;
  Eigen::VectorXd gravity_;
  Eigen::MatrixXd derivative_;
  LinearProgramme programme_;
  int heaviest_ = -1;
};

}  // namespace locograph
