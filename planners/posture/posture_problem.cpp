#include <locograph/common/check_option.h>
#include <locograph/planners/posture/posture_problem.h>

namespace locograph {

void PostureOptions::validate() const {
  termination.validate();
  check_option(max_restarts >= 0, "max_restarts", "0 or more");
  check_option(patience >= 1, "patience", "1 or more");
  check_option(max_iterations >= 1, "max_iterations", "1 or more");
  check_option(joint_margin_rad >= 0.0, "joint_margin_rad", "0 or more");
  check_option(self_margin_m >= 0.0, "self_margin_m", "0 or more");
  check_option(obstacle_margin_m >= 0.0, "obstacle_margin_m", "0 or more");
  check_option(ground_margin_m >= 0.0, "ground_margin_m", "0 or more");
  check_option(wrench_margin >= 0.0 && wrench_margin < 1.0, "wrench_margin", "a part in [0, 1)");
  check_option(torque_margin >= 0.0 && torque_margin < 1.0, "torque_margin", "a part in [0, 1)");
}

}  // namespace locograph
