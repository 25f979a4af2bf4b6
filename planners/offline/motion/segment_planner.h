#pragma once
/// Finds how a robot moves within one stance: from one configuration to another with the stance's
/// contacts closed, in balance, within joint limits and free of collisions.
///
///     SegmentSpace space(task.robot, task.world->world());  // segment_space.h
///     space.set_segment(segment);
///     const auto planner = make_segment_planner("interpolation");  // segment_planners.h
///     const SegmentPath path = planner->plan(space, {.seed = 7});
///     if (!path.success()) std::cerr << path.reason;
///
/// The second offline stage of Rossini et al., "Loco-Manipulation Planning for Legged Robots:
/// Offline and Online Strategies": a path for each stance, between the configurations in which it
/// begins and ends. Planners are chosen by name (segment_planners.h).

#include <locograph/planners/answer/planner_answer.h>
#include <locograph/planners/offline/motion/segment_space.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace locograph {

struct SegmentOptions {
  std::uint64_t seed = 0;
  Termination termination = {};
  /// That random trees may look at to find a way, and as many again to shorten it; no wall clock in
  /// decisions.
  int max_states = 20000;

  /// Throws Error naming the option that is out of range.
  void validate() const;
};

/// The reason of a failure: what was in the way last.
struct SegmentPath : PlannerAnswer {
  /// From Segment::from to Segment::to, both included. Each is closed to 1e-8, and
  /// the way between two neighbours, brought back to the contacts, is valid.
  std::vector<Eigen::VectorXd> waypoints = {};
  /// Not found, and no other posture would help: what swings is in the way of something itself.
  bool no_arc = false;
  /// Of random trees [as SegmentSpace::distance]: of the first way between from() and to(), and of
  /// the way once the tree ended, before straight ways took the place of its parts.
  double first_length = 0.0, tree_length = 0.0;
  /// Iterations: arcs, steps of the graph optimiser, or states, by the planner.
  PlannerStatistics statistics = {};
};

class SegmentPlanner {
 public:
  virtual ~SegmentPlanner() = default;
  virtual const std::string& name() const = 0;
  /// Throws Error for options out of range.
  SegmentPath plan(SegmentSpace& space, const SegmentOptions& options) const;

 private:
  /// Whether there is a path; else why not is in its reason. Counts iterations.
  virtual bool search(SegmentSpace& space, const SegmentOptions& options,
                      SegmentPath& path) const = 0;
};

}  // namespace locograph
