#include <locograph/common/check_option.h>
#include <locograph/planners/offline/motion/motion_options.h>

namespace locograph {

void MotionOptions::validate() const {
  check_option(step_s > 0.0, "step_s", "more than 0");
  check_option(smoothing_s >= 0.0, "smoothing_s", "0 or more");
  check_option(loaded_smoothing_s >= 0.0, "loaded_smoothing_s", "0 or more");
  check_option(lift_off_m >= 0.0, "lift_off_m", "0 or more");
  check_option(joint_acceleration_rad_s2 > 0.0, "joint_acceleration_rad_s2", "more than 0");
}

}  // namespace locograph
