#pragma once
/// Velocities and accelerations of a motion whose configurations are joined by straight steps.
///
///     MotionRates rates(context);
///     BalanceMotion now = rates.at(3, 0.25, MotionRates::Half::kFirst, state);
///
/// Along a step, joints, base position and base orientation change at constant rates, which jump at
/// the vertices: no robot can do that. The motion is taken for what a robot makes of it: the
/// velocity is that of the step in the middle of each step, and goes linearly from there to the
/// middle of the next one. The acceleration belongs to a vertex, then: the change of velocity there
/// over half the time of both steps. At the ends the robot is at rest, or goes on as it does.
///
/// A vertex next to a step that has no times or is not usable has no acceleration.

#include <locograph/check/balance_certificate.h>
#include <locograph/check/check_context.h>
#include <locograph/robots/robot_state.h>

#include <vector>

namespace locograph {

class MotionRates {
 public:
  explicit MotionRates(const CheckContext& context);

  enum class Half { kFirst, kSecond };

  /// In the order of Robot::tangent_size(): the base along its own axes in `state`, which is the
  /// robot at that fraction of the step from a vertex. Which half a fraction of 0.5 belongs to, has
  /// to be said.
  BalanceMotion at(int step, double fraction, Half half, const RobotState& state) const;
  /// At a vertex, where it does not matter of which step.
  BalanceMotion at(int vertex, const RobotState& state) const;

  /// Rates of the joints at a vertex per second; empty where there are none.
  Eigen::VectorXd joint_acceleration(int vertex) const;

 private:
  /// Joints; the base's velocity in the world, and its angular velocity along its own axes.
  struct Rate {
    Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
    Eigen::VectorXd joints;
    bool known = false;
  };
  Rate acceleration(int vertex) const;

  const Robot& robot_;
  const bool starts_at_rest_, ends_at_rest_;
  std::vector<double> duration_;
  std::vector<Rate> steps_;
};

}  // namespace locograph
