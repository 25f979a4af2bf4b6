#pragma once
/// Finds how a robot moves within one stance: from one configuration to another with the stance's
/// contacts closed, in balance, within joint limits and free of collisions.
///
///     SegmentSpace space(problem.robot, problem.world);           // segment_space.h
///     space.set_segment(segment);
///     const SegmentPath path = make_segment_planner("interpolation")->plan(space, {.seed = 7});
///     if (!path.found) std::cerr << path.reason;
///
/// The second offline stage of Rossini et al., "Loco-Manipulation Planning for Legged Robots:
/// Offline and Online Strategies": a path for each stance, between the configurations in which it
/// begins and ends. Planners are chosen by name, the cheapest first:
///
///   interpolation    configurations half-way, brought back to the contacts, again and again
///   optimisation     a graph of all configurations between the ends, by the graph optimiser
///   rrt_connect      OMPL's RRT-Connect on the manifold of closed contacts
///   atlas_rrt_star   OMPL's RRT* on an atlas of that manifold (Jaillet and Porta, "Asymptotically-
///                    optimal path planning on manifolds", RSS 2012), as in the paper

#include <locograph/common/deadline.h>
#include <locograph/planners/offline/motion/segment_space.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace locograph {

struct SegmentOptions {
  std::uint64_t seed = 0;
  Deadline deadline;
  /// That random trees may look at to find a way, and as many again to shorten it; no wall clock in
  /// decisions.
  int max_states = 20000;
};

struct SegmentPath {
  bool found = false;
  /// From Segment::from to Segment::to, both included. Each is closed to 1e-8, and
  /// the way between two neighbours, brought back to the contacts, is valid.
  std::vector<Eigen::VectorXd> waypoints = {};
  std::string reason = {};
  /// Not found, and no other posture would help: what swings is in the way of something itself.
  bool no_arc = false;
  /// Of random trees [as SegmentSpace::distance]: of the first way between from() and to(), and of
  /// the way once the tree ended, before straight ways took the place of its parts.
  double first_length = 0.0, tree_length = 0.0;
};

class SegmentPlanner {
 public:
  virtual ~SegmentPlanner() = default;
  virtual const std::string& name() const = 0;
  virtual SegmentPath plan(SegmentSpace& space, const SegmentOptions& options) const = 0;
};

/// In the order in which they are tried.
const std::vector<std::string>& segment_planner_names();
/// Throws Error for an unknown name, with those that are known.
std::unique_ptr<SegmentPlanner> make_segment_planner(const std::string& name);

}  // namespace locograph
