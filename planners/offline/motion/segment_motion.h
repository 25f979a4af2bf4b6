#pragma once
/// The motion within one stance: a path by the first planner that finds one, and its timing.
///
///     SegmentMover mover(task, options);
///     const SegmentMotion motion = mover.move(segment, bearing, 0, 1, {.seed = 7});
///     if (motion.success()) std::cout << motion.configurations.size() << " configurations\n";
///
/// The waypoints of a path become a spline through few of them: where it is off the contacts or
/// does not hold, more are added. It is timed from rest to rest (timing/path_timing.h), sampled
/// evenly, and slowed down by what the curve through the samples (check/motion_curve.h) is faster
/// than limits allow. The outcome depends on the arguments alone. One for each thread.
///
/// The path closes balls by the shortest turn since its beginning. The spline is followed instead:
/// along it the balls roll, and its configurations are moved to where they get. So its end is
/// another one than the segment's, by the difference.

#include <locograph/check/motion.h>
#include <locograph/planners/offline/motion/motion_options.h>
#include <locograph/planners/offline/motion/segment_planner.h>
#include <locograph/planners/offline/timing/path_timing.h>
#include <locograph/planners/task/task.h>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace locograph {

/// How a path becomes a motion.
struct SegmentPace {
  double slower = 1.0;  ///< the motion takes so many times as long, at least 1
  bool finer = false;   ///< the spline keeps closer to the path
  /// The most that it goes at places equally far apart along the path, in lengths of the path per
  /// second, linear between them; empty: as fast as limits allow.
  std::vector<double> most_speed = {};
};

struct SegmentStatistics : PlannerStatistics {  // of all planners that tried
  double path_s = 0.0, timing_s = 0.0;
};

/// The reason of a failure: of each planner.
struct SegmentMotion : PlannerAnswer {
  std::string planner;                          ///< that found the path
  bool no_arc = false;                          ///< see SegmentPath
  std::vector<Eigen::VectorXd> waypoints;       ///< of the path
  Eigen::VectorXd to;                           ///< where the motion ends
  std::vector<Eigen::VectorXd> configurations;  ///< equispaced in time, both ends included
  std::vector<Eigen::VectorXd> slopes;          ///< of each, as Motion::slopes; zero at both ends
  /// Of each configuration the part of the path before it, and how fast that grows [1/s].
  std::vector<double> share, speed;
  double duration_s = 0.0;
  double length = 0.0, straight = 0.0;  ///< SegmentSpace::distance, of the path and of its ends
  /// How far what swings from one place to another gets from all else, at most 0.1 m; of several
  /// the least. Nothing swings: none.
  std::optional<double> clear_m;
  SegmentStatistics statistics;
};

/// Its configurations, slopes and times from 0 on; of no stance.
Motion as_motion(const SegmentMotion& way);

class SegmentMover {
 public:
  /// Throws Error for unknown names of planners, and as SegmentSpace does.
  SegmentMover(const Task& task, const MotionOptions& options);

  /// bearing: the contacts that are held, with their areas, as planners count on them. first, end:
  /// numbers of the segment planners that are tried.
  SegmentMotion move(const Segment& segment, std::span<const BearingContact> bearing,
                     std::size_t first, std::size_t end, const SegmentOptions& options);
  /// The same path at another pace; without success there is no timing.
  void retime(const Segment& segment, std::span<const BearingContact> bearing,
              const SegmentPace& pace, SegmentMotion& motion);
  std::size_t planners() const { return planners_.size(); }
  /// Of a planner by its name.
  std::size_t number_of(const std::string& planner) const;

 private:
  /// A configuration of a way, so far from where it begins.
  struct Node {
    double at;
    Eigen::VectorXd q;
  };

  /// How far each ball has slipped from the beginning of a spline, at kRollParts places of each of
  /// its pieces and at its end.
  using Slips = std::vector<std::vector<Eigen::Vector2d>>;

  /// A spline through as few configurations of a way as keep it closed and valid; nothing: they do
  /// not close where balls get. Ends at `to`; where that is empty it is found.
  std::optional<PathSpline> close(const std::vector<Eigen::VectorXd>& waypoints, bool finer,
                                  Eigen::VectorXd& to);
  Slips slips_along(const PathSpline& path);
  /// Closure from where balls are in q once they had not slipped.
  void roll_from(const Eigen::VectorXd& q, const std::vector<Eigen::Vector2d>& slips);
  /// Moves nodes to where balls get along the spline through them, which it returns.
  std::optional<PathSpline> roll(std::vector<Node>& nodes, bool end_is_fixed, Slips& slips);
  void drop_repeated(std::vector<Node>& nodes) const;
  PathSpline spline_through(const std::vector<Node>& nodes) const;
  Node on_way(const std::vector<Node>& way, double at);
  /// What the spline has to go through as well between nodes i - 1 and i; nothing: it holds.
  std::optional<Node> missing(const PathSpline& path, std::size_t i, const std::vector<Node>& way,
                              const std::vector<Node>& nodes, const Slips& slips);
  /// Gives a motion with waypoints all the rest.
  void shape(std::span<const BearingContact> bearing, const SegmentPace& pace,
             SegmentMotion& motion);
  bool time(const PathSpline& path, std::span<const BearingContact> bearing,
            const SegmentPace& pace, SegmentMotion& motion);
  /// Forces have to follow the motion: its accelerations do not jump.
  bool bears_on() const { return task_.margin.dwell_s > 0.0; }
  void sample(const PathTiming& timing, double slower, int steps, SegmentMotion& motion);
  std::optional<double> clear_of(const SegmentMotion& motion);
  void hold_wheels(std::vector<Eigen::VectorXd>& configurations);
  void take_slopes(const std::vector<bool>& moved, SegmentMotion& motion);
  void keep_limits(SegmentMotion& motion);

  const Task& task_;
  const MotionOptions& options_;
  SegmentSpace space_;
  std::vector<BallTrack> tracks_;  ///< of the balls that are held
  TimingLimits limits_;
  std::vector<std::unique_ptr<SegmentPlanner>> planners_;
};

}  // namespace locograph
