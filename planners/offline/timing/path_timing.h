#pragma once
/// The fastest motion along a path, from rest to rest, and what it is at any time.
///
///     TimingLimits limits = timing_limits(robot, task.check);
///     PathTiming timing(robot, waypoints, limits, {.smoothing_s = 0.05});
///     if (timing.answer().success()) TimedPath motion = timing.sampled(0.01);
///
/// The path is path_spline.h's, its speeds are speed_profile.h's. Limits hold at every time, so
/// they hold for the judge, who sees configurations only: the velocity of a step and the
/// acceleration at a vertex are means of those in between, and means of what is within limits are.
///
/// The fastest motion jumps from one acceleration to another. With smoothing, s(t) is its mean over
/// a time T before t: the same path, accelerations that are continuous and d^3s/dt^3 of at most the
/// difference of two accelerations over T. It takes T longer, and then as much as it needs to be
/// slowed down, evenly, because limits along the path change within T. Rows whose c is below 0
/// bound that from above.
///
/// Thread-safety: const, freely shared. The robot must outlive it.

#include <locograph/planners/offline/timing/speed_profile.h>

#include <vector>

namespace locograph {

struct TimingOptions {
  int intervals = 1000;         ///< of the grid of s, at least
  int intervals_per_step = 16;  ///< between two waypoints, at least
  /// From the straight way between waypoints, see path_spline.h.
  double max_deviation = std::numeric_limits<double>::infinity();
  double smoothing_s = 0.0;  ///< T; 0: accelerations jump
  Termination termination = {};

  /// Throws Error naming the option that is out of range.
  void validate() const;
};

struct TimedPath {
  std::vector<double> time_s;
  std::vector<Eigen::VectorXd> configurations;
  std::vector<Eigen::VectorXd> velocities, accelerations;  ///< tangents, and their derivatives
  double duration_s = 0.0;
};

struct TimedPoint {
  Eigen::VectorXd configuration, velocity, acceleration;
  double s = 0.0, speed = 0.0;  ///< on the path; ds/dt
};

/// The path that PathTiming makes of waypoints.
PathSpline timing_path(const Robot& robot, std::vector<Eigen::VectorXd> waypoints,
                       const TimingLimits& limits,
                       double max_deviation = std::numeric_limits<double>::infinity());

class PathTiming {
 public:
  /// Throws Error for waypoints, limits, options and rows that make no sense.
  PathTiming(const Robot& robot, std::vector<Eigen::VectorXd> waypoints, const TimingLimits& limits,
             const TimingOptions& options = {}, const TimingRowsAt& rows = {});
  /// Of a path that is there already, for rows that depend on it; without max_deviation.
  PathTiming(PathSpline path, const TimingLimits& limits, const TimingOptions& options = {},
             const TimingRowsAt& rows = {});

  /// Infeasible when the rows leave no motion from rest to rest; limits alone always leave one.
  const PlannerAnswer& answer() const { return answer_; }
  const PlannerStatistics& statistics() const { return statistics_; }  ///< as of FastestProfile
  /// The rest throws Error without success.
  double duration_s() const;
  /// time_s is clamped to [0, duration_s()].
  TimedPoint at(double time_s) const;
  /// Equidistant, both ends included, no more than step_s apart.
  TimedPath sampled(double step_s) const;

  const PathSpline& path() const { return path_; }

 private:
  struct Progress {
    double s = 0.0, speed = 0.0, acceleration = 0.0;
  };
  /// Of times that are not slowed down: without and with smoothing.
  Progress raw(double time) const;
  Progress smooth(double time) const;
  long double integral(double time) const;
  std::size_t interval(double time) const;
  std::vector<double> smooth_pieces() const;
  bool slow_down(const TimingLimits& limits, const TimingRowsAt& rows);

  PathSpline path_;
  SpeedProfile profile_;
  std::vector<double> time_s_;         // of the grid points
  std::vector<long double> integral_;  // of s, up to there
  double smoothing_s_ = 0.0, slower_ = 1.0;
  PlannerAnswer answer_;
  PlannerStatistics statistics_;
};

}  // namespace locograph
