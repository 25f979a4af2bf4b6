#include <locograph/common/check_option.h>
#include <locograph/planners/posture/transition_problem.h>

#include <array>

namespace locograph {

void TransitionOptions::validate() const {
  check_option(max_iterations >= 1, "max_iterations", "1 or more");
  check_option(patience >= 1, "patience", "1 or more");
  check_option(restarts >= 0, "restarts", "0 or more");
  check_option(joint_margin_rad >= 0.0, "joint_margin_rad", "0 or more");
  check_option(self_margin_m >= 0.0, "self_margin_m", "0 or more");
  check_option(surface_margin_m >= 0.0, "surface_margin_m", "0 or more");
  check_option(obstacle_margin_m >= 0.0, "obstacle_margin_m", "0 or more");
  check_option(border_margin_m >= 0.0, "border_margin_m", "0 or more");
  check_option(balance_margin_m >= 0.0, "balance_margin_m", "0 or more");
  check_option(torque_margin >= 0.0 && torque_margin < 1.0, "torque_margin", "a part in [0, 1)");
  termination.validate();
}

HeldBalls held_balls(const RobotState& state, std::span<const Contact> contacts,
                     const std::function<bool(const Contact&)>& held) {
  HeldBalls balls;
  for (const Contact& contact : contacts) {
    const bool rolls = is_ball(contact.effector) && held(contact);
    balls.push_back(rolls ? std::optional(BallPose(state, contact.effector)) : std::nullopt);
  }
  return balls;
}

const std::string& transition_failure_name(TransitionFailure failure) {
  static const std::array<std::string, 9> names = {"none",           "contact", "joint limit",
                                                   "self-collision", "surface", "obstacle",
                                                   "balance",        "torque",  "border"};
  return names[static_cast<std::size_t>(failure)];
}

}  // namespace locograph
