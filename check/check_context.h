#pragma once
/// What the rooms of the judge share while one motion is checked.
///
///     CheckContext context{robot, world, exact, motion, options, &shapes, curve, job};
///     for (const Stance& stance : motion.stances)
///       context.stances.emplace_back(robot, world, stance, options.known);
///     for (std::size_t i = 0; i < context.vertices(); ++i)
///       for (const JudgedStance* stance : context.stances_at(int(i))) use(*stance);

#include <locograph/check/check_report.h>
#include <locograph/check/judged_stance.h>
#include <locograph/check/motion_curve.h>
#include <locograph/check/moving_shapes.h>
#include <locograph/common/job_control.h>
#include <locograph/world/collision_world.h>
#include <locograph/world/world.h>

#include <mutex>
#include <vector>

namespace locograph {

/// Which vertices have finite numbers, and between which the motion can be looked at: steps[i]
/// leads from vertex i to i + 1.
struct UsableParts {
  std::vector<bool> vertices, steps;
};

/// Thrown where the job ends a check, caught where it began.
struct CheckStopped {};

struct CheckContext {
  const Robot& robot;
  const World& world;
  const CollisionWorld& exact;
  const Motion& motion;
  const CheckOptions& options;
  MovingShapes* shapes;  ///< null for a single configuration
  const MotionCurve& curve;
  const JobControl& job;
  double cutoff_m = 0.5;  ///< of distances
  bool single = false;    ///< one configuration, not a motion

  std::vector<JudgedStance> stances = {};
  UsableParts usable = {};
  std::vector<int> samples_per_step = {};
  int samples = 0;  ///< looked at so far
  mutable std::mutex asking = {};

  /// To be called before each piece of work, by any thread. part: of the check. Throws
  /// CheckStopped.
  void begin_work(const char* part, int vertex) const {
    const std::lock_guard<std::mutex> lock(asking);
    job.report_progress(part, std::size_t(vertex), vertices());
    if (job.termination.ended()) throw CheckStopped();
  }
  std::size_t vertices() const { return motion.configurations.size(); }
  /// Null: not known.
  const JudgedStance* stance_from(int vertex) const {
    if (motion.stance_from.empty()) return nullptr;
    const int stance = motion.stance_from[std::size_t(vertex)];
    return stance < 0 ? nullptr : &stances[std::size_t(stance)];
  }
  /// The stances that a vertex is to be feasible for: of the steps before and after it.
  std::vector<const JudgedStance*> stances_at(int vertex) const {
    std::vector<const JudgedStance*> result;
    for (const int step : {vertex - 1, vertex}) {
      const JudgedStance* stance = step < 0 ? nullptr : stance_from(step);
      if (stance != nullptr && (result.empty() || result[0] != stance)) result.push_back(stance);
    }
    return result;
  }
  /// Something moves between the vertices.
  bool moves() const { return !motion.stances_only && vertices() > 1; }
  std::string why_nothing_moves() const {
    return motion.stances_only ? "a plan of stances has no motion"
                               : "one configuration: nothing moves";
  }
};

/// Poses of all links of a configuration, whose quaternion need not have norm 1.
using LinkPoses = std::vector<Eigen::Isometry3d>;

}  // namespace locograph
