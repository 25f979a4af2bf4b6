#pragma once
/// Rows of timing within which contacts balance a floating base that moves.
///
///     BalanceRows balance(robot, bearing);                         // of one stance
///     const PathSpline path = timing_path(robot, waypoints, limits);
///     PathTiming timing(path, limits, options, balance.along(path, limits));
///
/// With h of dynamics.h, the base asks its contacts for the wrench of M (q' u + q'' x) + h, linear
/// in u = d^2s/dt^2 and x = (ds/dt)^2. Wrenches that contacts can give are convex: forces within
/// friction pyramids, areas and limits of force, which do not move while a stance lasts. So each
/// half-space y . wrench <= r that holds them all makes a row that is true along the whole path
/// (Hauser, "Fast interpolation and time-optimization with contact", IJRR 33(9), 2014, has the
/// polygon of (u, x) at a point). Half-spaces are found where they are needed: at places on the
/// path, linear programmes look from a wrench inside towards the corners of what the limits and the
/// rows so far leave, and the dual variables of one that cannot be reached are a half-space
/// between. They are kept for the next path in the stance.
///
/// Balls roll along the path, and r is worked out anew at each point for where they are.
///
/// With torque limits, torques join the wrench. What forces do to them changes along the path, so
/// that r is worked out anew at each point: true, but tight at the point of the half-space only.
///
/// A row leaves unused the part `margin` of what is left of contacts (and efforts) at rest. Thus a
/// posture that contacts balance at rest never makes a path impossible. Friction, areas and limits
/// of force are taken 2 % smaller, as the judge's pyramids have other sides.
///
/// Thread-safety: one thread at a time. The robot must outlive it, not what along() returns.

#include <locograph/planners/balance/balance_region.h>
#include <locograph/planners/offline/timing/speed_profile.h>

#include <memory>
#include <span>

namespace locograph {

struct BalanceRowsOptions {
  double margin = 0.1;        ///< 0 to less than 1
  double effort_scale = 0.0;  ///< of the URDF's efforts, which limit torques; 0: no limit
  int pieces = 16;            ///< of a path, at least; between two knots there is one at least
  int looks = 16;             ///< places on a path where half-spaces are looked for, about

  /// Throws Error naming the option that is out of range.
  void validate() const;
};

class BalanceRows {
 public:
  /// Throws Error for a fixed base and options that make no sense.
  BalanceRows(const Robot& robot, std::span<const BearingContact> contacts,
              const BalanceRowsOptions& options = {});
  ~BalanceRows();
  BalanceRows(BalanceRows&&) noexcept;

  /// Rows are worked out at the ends and in the middle of pieces and are quadratics in between.
  /// They say nothing of speeds and accelerations that limits do not allow. None, where the limits
  /// alone leave no motion.
  TimingRowsAt along(const PathSpline& path, const TimingLimits& limits);

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace locograph
