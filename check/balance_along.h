#pragma once
/// Judges balance and torques along a motion: at every vertex on the stances of both steps, and
/// between the vertices where the margin is so small that the motion could use it up.
///
///     BalanceAlong balance(context);
///     balance.run();
///     balance.report(report.violations);
///
/// What bears is what of each contact lies on the surfaces and bars of the world (judged_stance.h),
/// with their friction. Where the motion has times, inertial forces count (motion_rates.h); they
/// change at once in the middle of a step, so each half is looked at by itself.
///
/// How far a margin can fall is estimated, not bounded: by 10 for each metre that contacts move as
/// seen from the centre of mass, or that gravity turns at 1 m; on an area of half size h below
/// 0.1 m, by 1 / h. Where the ends of an interval and its path leave room for a margin below the
/// limit, the interval is halved, down to CheckOptions::balance_resolution_m of path.

#include <locograph/check/balance_certificate.h>
#include <locograph/check/check_context.h>
#include <locograph/check/motion_rates.h>
#include <locograph/check/violation_tally.h>

#include <optional>
#include <vector>

namespace locograph {

class BalanceAlong {
 public:
  explicit BalanceAlong(CheckContext& context);

  void run();
  /// static_balance, torque_limits.
  void report(std::vector<Violation>& violations) const;

  const std::optional<BalanceCertificate>& worst() const { return worst_; }
  std::optional<double> min_margin() const;
  std::optional<double> max_torque_ratio() const;

 private:
  using Half = MotionRates::Half;
  struct Sample {
    double fraction = 0.0, margin = 0.0;
    std::vector<Eigen::Vector3d> arms;  // contacts from the centre of mass; gravity; base axes
  };

  /// At a vertex, or in a half of the step from it.
  Sample judge(int vertex, double fraction, std::optional<Half> half, const JudgedStance& stance);
  void run_half(int step, Half half, const JudgedStance& stance, double margin_at_vertex);
  void refine(int step, Half half, const JudgedStance& stance, const Sample& from,
              const Sample& to);
  double steepest_fall() const;
  BalanceOptions options_for(const JudgedStance& stance, const LinkPoses& poses,
                             std::vector<Contact>& contacts);
  void record(const BalanceCertificate& certificate, bool torques, int vertex, double time_s);

  CheckContext& context_;
  MotionRates rates_;
  MotionSampler& sampler_;
  LinkPoses poses_;
  double smallest_half_m_ = 0.1;  // of the areas looked at
  std::optional<BalanceCertificate> worst_;
  ViolationTally static_balance_, torque_limits_;
};

}  // namespace locograph
