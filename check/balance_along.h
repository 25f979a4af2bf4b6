#pragma once
/// Judges balance and torques along a motion: at every vertex on the stances of both steps, and
/// between the vertices where the margin is so small that the motion could use it up.
///
///     BalanceAlong balance(context);
///     balance.run(threads);
///     balance.report(report.violations);
///
/// What bears is what of each contact lies on the surfaces and bars of the world (judged_stance.h),
/// with their friction. Where the motion has times, inertial forces of its curve count
/// (motion_curve.h): accelerations jump at vertices, so each is judged as the step before it ends
/// and as the one after it begins. Within a step they change linearly but for what turns; steps of
/// more than 0.05 s are looked at that often, in 64 pieces at most. A whole motion is judged at
/// rest, too, where it begins and where it ends.
///
/// How far a margin can fall is estimated, not bounded: by 10 for each metre that contacts move as
/// seen from the centre of mass, or that gravity, or the normal of a ball on a bar, turns at 1 m;
/// on an area of half size h below 0.1 m, by 1 / h. Where the ends of an interval and its path
/// leave room for a margin below the limit, the interval is halved, down to
/// CheckOptions::balance_resolution_m of path. h is the least of all vertices and of the step.
///
/// Most linear programmes are not needed. The report tells the least margin and the largest of the
/// least torques of the whole motion; where wrenches found nearby prove (nearby_balance.h) that a
/// sample is inside all limits and comes near neither, by more than what counts as equal
/// (violation_tally.h), its programme cannot change the report, and is left out. What is known when
/// that is decided depends on the place along the motion only: first every sixteenth vertex, then
/// the vertices in between, in pieces of sixteen, then the steps. The same report for any number of
/// threads, and with CheckOptions::prove_nearby off.

#include <locograph/check/balance_certificate.h>
#include <locograph/check/balance_worker.h>
#include <locograph/check/check_context.h>
#include <locograph/check/violation_tally.h>
#include <locograph/common/thread_pool.h>

#include <memory>
#include <optional>
#include <vector>

namespace locograph {

class BalanceAlong {
 public:
  explicit BalanceAlong(CheckContext& context);

  void run(ThreadPool& threads);
  /// static_balance, torque_limits.
  void report(std::vector<Violation>& violations) const;

  const std::optional<BalanceCertificate>& worst() const { return worst_; }
  std::optional<double> min_margin() const;
  std::optional<double> max_torque_ratio() const;

 private:
  void know(const std::vector<BalanceFindings::List>& all);
  static bool all_verified(const std::vector<BalanceFindings::List>& all);
  void record(const BalanceFindings::List& findings);
  void tell() const;

  CheckContext& context_;
  std::vector<std::unique_ptr<BalanceWorker>> workers_;
  BalanceFindings found_;
  std::optional<BalanceCertificate> worst_;
  ViolationTally static_balance_, torque_limits_;
};

}  // namespace locograph
