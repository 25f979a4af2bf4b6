#pragma once
/// How a contact task's stances become a motion.
///
///     const MotionOptions options{.segment_planners = {"interpolation"}, .step_s = 0.05};

#include <string>
#include <vector>

namespace locograph {

struct MotionOptions {
  std::string stance_planner = "guided";  ///< see stance_planners.h
  /// Names of segment planners in the order in which they are tried; empty: all.
  std::vector<std::string> segment_planners = {};
  double step_s = 0.02;       ///< between configurations of the plan, at most
  double smoothing_s = 0.04;  ///< of accelerations, see path_timing.h
  /// The same where forces have to follow: with an execution margin that has a dwell.
  double loaded_smoothing_s = 0.14;
  double lift_off_m = 0.035;  ///< along normals, before and after a swing
  /// Where the scenario has no limit of accelerations [rad/s^2, m/s^2 of prismatic joints].
  double joint_acceleration_rad_s2 = 10.0;

  /// Throws Error naming the option that is out of range; names are looked up where they are used.
  void validate() const;
};

}  // namespace locograph
