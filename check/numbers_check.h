#pragma once
/// Judges the numbers of a motion: finite, of the right size, in order of time, within the limits
/// of joints and rates, at rest at its ends. Exact between vertices: at the extrema of the cubics
/// there (motion_curve.h); of the base's turn but for terms of the fourth order in a step's angle.
///
///     NumbersCheck numbers(context);
///     numbers.run();                 // fills context.usable and context.samples_per_step
///     numbers.report(report.violations);

#include <locograph/check/check_context.h>
#include <locograph/check/violation_tally.h>

#include <optional>
#include <vector>

namespace locograph {

class NumbersCheck {
 public:
  explicit NumbersCheck(CheckContext& context);

  void run();
  /// not_finite, configuration_size, base_orientation, time_order, step_size, joint_limits,
  /// velocity_limits, base_velocity, acceleration_limits, end_at_rest.
  void report(std::vector<Violation>& violations) const;
  std::optional<double> max_velocity_ratio() const;

 private:
  void check_numbers(int vertex);
  void check_joint_limits(int vertex, double fraction, const Eigen::VectorXd& q);
  void check_step(int vertex);
  void check_joint(int vertex, const CurveStep& step, int joint);
  void check_velocity(int vertex, double fraction, int joint, double velocity);
  void check_acceleration(int vertex, double fraction, int joint, double acceleration);
  void check_base_velocity(int vertex, const CurveStep& step, const StepBounds& bounds);
  void check_at_rest(int vertex);
  double samples_needed(const StepBounds& step);
  double time(int vertex) const { return context_.motion.time_s[std::size_t(vertex)]; }

  CheckContext& context_;
  const Robot& robot_;
  const CheckOptions& options_;
  ViolationTally not_finite_, configuration_size_, base_orientation_, time_order_, step_size_,
      joint_limits_, velocity_limits_, base_velocity_, acceleration_limits_, end_at_rest_;
};

}  // namespace locograph
