#include <locograph/common/check_option.h>
#include <locograph/plugins/configuration/execution_margin.h>

namespace locograph {

ExecutionMargin ExecutionMargin::none() {
  return {.friction = 1.0,
          .area = 1.0,
          .torque = 1.0,
          .joint_rad = 0.0,
          .self_distance_m = 0.0,
          .least_force = 0.0,
          .dwell_s = 0.0};
}

ExecutionMargin ExecutionMargin::scaled(double factor) const {
  const auto share = [factor](double of) { return 1.0 - factor * (1.0 - of); };
  return {.friction = share(friction),
          .area = share(area),
          .torque = share(torque),
          .joint_rad = factor * joint_rad,
          .self_distance_m = factor * self_distance_m,
          .least_force = factor * least_force,
          .dwell_s = factor * dwell_s};
}

void ExecutionMargin::validate() const {
  const auto share = [](double of) { return of > 0.0 && of <= 1.0; };
  check_option(share(friction), "friction", "a share above 0, at most 1");
  check_option(share(area), "area", "a share above 0, at most 1");
  check_option(share(torque), "torque", "a share above 0, at most 1");
  check_option(joint_rad >= 0.0 && joint_rad <= kMostJoint_rad, "joint_rad", "0 to 1 rad");
  check_option(self_distance_m >= 0.0 && self_distance_m <= kMostSelfDistance_m, "self_distance_m",
               "0 to 0.2 m");
  check_option(least_force >= 0.0 && least_force < 1.0, "least_force",
               "a part of the weight, 0 or more, less than 1");
  check_option(dwell_s >= 0.0 && dwell_s <= kMostDwell_s, "dwell_s", "0 to 60 s");
}

}  // namespace locograph
