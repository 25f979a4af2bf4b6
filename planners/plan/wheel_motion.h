#pragma once
/// Steers and turns the wheels of a configuration so that they roll: first guesses for planners.
///
///     WheelMotion wheels(robot, parameter);
///     wheels.steer(q, 0, {1.0, 0.2});       // wheel 0 heads along (1, 0.2) in the world
///     wheels.roll(before, q);               // every wheel turns as far as its centre has come

#include <locograph/plugins/configuration/robot_parameters.h>
#include <locograph/robots/robot_state.h>

#include <Eigen/Core>

namespace locograph {

class WheelMotion {
 public:
  WheelMotion(const Robot& robot, const WheelsParameter& wheels);

  /// Turns the joint above a wheel's carrier until the wheel heads along a direction of the ground,
  /// either way round, whichever turn is smaller and within the joint's limits. Returns false, q
  /// unchanged, when there is none: no such joint, one that is not upright, or limits in the way.
  bool steer(Eigen::VectorXd& q, int wheel, const Eigen::Vector2d& direction);

  /// Sets the wheel joints of `to`: where they were in `from`, plus the way of the wheel's centre
  /// along its mean heading over its radius.
  void roll(const Eigen::VectorXd& from, Eigen::VectorXd& to);

  /// Centre and heading (axle × up) of a wheel, world frame.
  struct Pose {
    Eigen::Vector3d centre, heading;
  };
  Pose pose(const Eigen::VectorXd& q, int wheel);

 private:
  Pose current(const Wheel& wheel) const;

  const Robot& robot_;
  const WheelsParameter& wheels_;
  RobotState state_;
  std::vector<Pose> before_;
};

}  // namespace locograph
