#pragma once
/// The fastest speeds along a path: time-optimal path parametrisation by reachability analysis.
///
///     TimingLimits limits = timing_limits(robot, task.check);
///     const FastestProfile fastest = fastest_profile(path, limits);
///     if (!fastest.success()) std::cerr << fastest.reason;
///
/// Pham & Pham 2018, "A new approach to time-optimal path parameterization based on reachability
/// analysis" (TOPP-RA). With x = (ds/dt)^2 and u = d^2s/dt^2, tangent velocities are q' sqrt(x) and
/// their derivatives q' u + q'' x, so limits are linear in (u, x). The grid's controllable sets,
/// the x from which the end can be reached at rest, are intervals; they are worked out backwards,
/// then the largest x within them is taken forwards.
///
/// u is constant between two grid points, hence x = x0 + 2 u (s - s0). What the paper asks at grid
/// points is asked here of all in between: on a cubic path q' u + q'' x is a quadratic of s between
/// two grid points, and its three Bernstein coefficients bound it. They are linear in x at both
/// ends, which are the unknowns of the linear programmes: polygons, clipped. For base and rows,
/// which are no quadratics, this holds but for terms of third order in the step of the grid.

#include <locograph/check/check_report.h>
#include <locograph/planners/answer/planner_answer.h>
#include <locograph/planners/offline/timing/path_spline.h>

#include <functional>
#include <vector>

namespace locograph {

/// By tangent coordinate, > 0; infinity: none. Accelerations are derivatives of tangent velocities.
struct TimingLimits {
  Eigen::VectorXd velocity, acceleration;
  double base_linear_m_s = std::numeric_limits<double>::infinity();     ///< largest speed
  double base_angular_rad_s = std::numeric_limits<double>::infinity();  ///< the same
  /// The largest ds/dt at a place s of the path, above 0; may be empty. It may change slowly only:
  /// it holds at the points of the grid, and smoothing (path_timing.h) does not look at it.
  std::function<double(double)> path_speed = {};
};

/// Joint velocities of the URDF, the rest as the judge asks it.
TimingLimits timing_limits(const Robot& robot, const CheckOptions& limits);

/// a u + b x <= c, row by row, of one point of a path. A torque is M q' u + (M q'' + C(q, q') q') x
/// + g, so that its limit makes two rows.
struct TimingRows {
  Eigen::VectorXd a, b, c;
};
/// As many rows at every point.
using TimingRowsAt = std::function<TimingRows(const PathPoint&)>;

struct SpeedProfile {
  std::vector<double> s;        ///< from 0 to the length of the path
  std::vector<double> squared;  ///< x there; 0 at both ends only
};

/// Of the grid of s, both at least; a step between waypoints that turns the base has one interval
/// for each 0.02 rad. Where waypoints are dense, a few per step suffice.
struct GridSize {
  int intervals = 1000, intervals_per_step = 16;

  /// Throws Error naming the size that makes no sense.
  void validate() const;
};

struct FastestProfile : PlannerAnswer {
  SpeedProfile profile = {};          ///< of success
  PlannerStatistics statistics = {};  ///< iterations: intervals, from the end of the path
};

/// Infeasible when the rows leave no way to move from rest to rest; limits alone always leave one.
/// Throws Error for limits and sizes that make no sense, for a part of the path where nothing that
/// moves has a limit, and for rows that do not match.
FastestProfile fastest_profile(const PathSpline& path, const TimingLimits& limits,
                               const GridSize& size = {}, const TimingRowsAt& rows = {},
                               const Termination& termination = {});

/// Throws Error naming the limit that makes no sense.
void check_limits(const Robot& robot, const TimingLimits& limits);

}  // namespace locograph
