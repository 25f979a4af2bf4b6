#pragma once
/// The smallest distance along a motion, to obstacles or of the robot to itself, between the
/// vertices as well: branch and bound over time.
///
///     locograph::ClearanceSearch search(robot, world, motion, shapes, options);
///     search.run(locograph::ClearanceSearch::Kind::kObstacles, usable, tally);
///
/// A distance changes by no more than what the things concerned travel. If it is d0 and d1 at the
/// ends of an interval in which they travel at most L, it is at least (d0 + d1 - L) / 2 inside.
/// Intervals whose bound could matter (see CheckOptions::clearance_resolution_m) are halved.

#include <locograph/planners/plan/check_report.h>
#include <locograph/planners/plan/motion_interpolation.h>
#include <locograph/planners/plan/moving_shapes.h>
#include <locograph/planners/plan/obstacle_path.h>
#include <locograph/planners/plan/violation_tally.h>
#include <locograph/world/collision_world.h>

#include <vector>

namespace locograph {

/// Which vertices have finite numbers, and between which the motion can be looked at: steps[i]
/// leads from vertex i to i + 1.
struct UsableParts {
  std::vector<bool> vertices, steps;
};

class ClearanceSearch {
 public:
  enum class Kind { kObstacles, kSelf };

  /// Keeps references to everything.
  ClearanceSearch(const Robot& robot, const CollisionWorld& world, const Motion& motion,
                  MovingShapes& shapes, const CheckOptions& options);

  /// Throws Error if the tally's limit is beyond the cutoff of the world.
  void run(Kind kind, const UsableParts& usable, ViolationTally& tally);

  int samples() const { return samples_; }

 private:
  struct Sample {
    double fraction = 0.0, distance = 0.0;
    std::vector<Eigen::Isometry3d> world_from_link;
  };

  Sample sample(int vertex, double fraction, ViolationTally& tally);
  void refine(int step, const Sample& from, const Sample& to, ViolationTally& tally);
  double path_bound(int step, const Sample& from, const Sample& to) const;

  const Robot& robot_;
  const CollisionWorld& world_;
  const Motion& motion_;
  MovingShapes& shapes_;
  const CheckOptions& options_;
  MotionSampler sampler_;
  ObstaclePath obstacle_path_;
  Kind kind_ = Kind::kObstacles;
  int samples_ = 0;
};

}  // namespace locograph
