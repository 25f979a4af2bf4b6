#pragma once
/// Steers and turns the wheels of a configuration so that they roll: first guesses for planners.
///
///     WheelMotion wheels(robot, stance);
///     wheels.steer(q, 0, {1.0, 0.2, 0.0});  // the stance's first wheel heads along (1, 0.2)
///     wheels.roll(before, q);               // every wheel turns as far as its centre has come

#include <locograph/plugins/configuration/stance_parameter.h>
#include <locograph/robots/robot_state.h>

#include <Eigen/Core>
#include <vector>

namespace locograph {

class WheelMotion {
 public:
  /// Of the wheels that stand in the stance. Throws Error for one that is no sound wheel.
  WheelMotion(const Robot& robot, const Stance& stance);

  int wheels() const { return static_cast<int>(wheels_.size()); }
  const StanceParameter::StandingWheel& wheel(int number) const {
    return wheels_[static_cast<std::size_t>(number)];
  }

  /// The active joint above a wheel's carrier, which steers it; -1: none.
  int steering_joint(int wheel) const;
  /// Turns the joint above a wheel's carrier until the wheel heads along a direction of its plane,
  /// either way round, whichever turn is smaller and within the joint's limits. Returns false, q
  /// unchanged, when there is none: no such joint, one that is not normal to the plane, or limits
  /// in the way.
  bool steer(Eigen::VectorXd& q, int wheel, const Eigen::Vector3d& direction);

  /// Sets the wheel joints of `to`: where they were in `from`, plus the way of the wheel's centre
  /// along its mean heading over its radius. A locked wheel's stays.
  void roll(const Eigen::Ref<const Eigen::VectorXd>& from, Eigen::Ref<Eigen::VectorXd> to);

  /// Sets the joints of locked wheels of `to` so that they do not turn on the ground: what their
  /// carriers pitch from `from` to `to`, they turn back.
  void hold(const Eigen::Ref<const Eigen::VectorXd>& from, Eigen::Ref<Eigen::VectorXd> to);

  /// Steers the wheels that can be along a way of the base, which turns by an angle about the
  /// vertical meanwhile, and rolls them from the configuration before: `to` is on that way.
  void drive(const Eigen::Ref<const Eigen::VectorXd>& from, const Eigen::Vector3d& way, double turn,
             Eigen::VectorXd& to);

  WheelPose pose(const Eigen::VectorXd& q, int wheel);

 private:
  const Robot& robot_;
  std::vector<StanceParameter::StandingWheel> wheels_;
  RobotState state_;
  std::vector<WheelPose> before_;
  std::vector<double> pitch_before_;
};

}  // namespace locograph
