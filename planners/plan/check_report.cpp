#include <locograph/common/error.h>
#include <locograph/planners/plan/check_report.h>

#include <cmath>
#include <limits>

namespace locograph {

void CheckOptions::validate() const {
  const auto positive = [](double value, const char* name) {
    if (!(value > 0.0) || !std::isfinite(value))
      throw Error(std::string("check option ") + name + " is " + std::to_string(value),
                  "a positive number");
  };
  const auto not_negative = [](double value, const char* name) {
    if (!(value >= 0.0) || !std::isfinite(value))
      throw Error(std::string("check option ") + name + " is " + std::to_string(value),
                  "a number that is not negative");
  };
  positive(max_step_m, "max_step_m");
  positive(max_step_rad, "max_step_rad");
  positive(max_samples_per_step, "max_samples_per_step");
  positive(clearance_resolution_m, "clearance_resolution_m");
  not_negative(min_clearance_m, "min_clearance_m");
  not_negative(min_self_clearance_m, "min_self_clearance_m");
  not_negative(max_obstacle_speed_m_s, "max_obstacle_speed_m_s");
  not_negative(ground_tolerance_m, "ground_tolerance_m");
  not_negative(wheel_mount_ground_tolerance_m, "wheel_mount_ground_tolerance_m");
  not_negative(contact_tolerance_m, "contact_tolerance_m");
  not_negative(max_wheel_tilt_rad, "max_wheel_tilt_rad");
  not_negative(max_lateral_slip_m, "max_lateral_slip_m");
  not_negative(max_longitudinal_slip_m, "max_longitudinal_slip_m");
  not_negative(joint_tolerance_rad, "joint_tolerance_rad");
  not_negative(velocity_tolerance, "velocity_tolerance");
  not_negative(quaternion_tolerance, "quaternion_tolerance");
  if (!(min_balance_margin < 1.0) || !std::isfinite(min_balance_margin))
    throw Error("check option min_balance_margin is " + std::to_string(min_balance_margin),
                "a number below 1");
  if (!std::isfinite(ground_z_m) && ground_z_m != -std::numeric_limits<double>::infinity())
    throw Error("check option ground_z_m is " + std::to_string(ground_z_m),
                "a height, or -infinity for no ground");
  if (obstacles)
    for (const Obstacle& obstacle : *obstacles) obstacle.validate();
}

const Violation& CheckReport::constraint(const std::string& name) const {
  for (const Violation& violation : violations)
    if (violation.constraint == name) return violation;
  throw Error("no constraint \"" + name + "\" in the report", "one that check_motion lists");
}

}  // namespace locograph
