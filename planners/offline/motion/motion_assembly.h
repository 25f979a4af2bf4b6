#pragma once
/// Puts the segments of a way through stances together: one after the other, each from rest to
/// rest, and where the robot's margin has a dwell it stands at each change of stance and at the end
/// while forces go over. For the motion planner.
///
/// A dwell is in the stance with more contacts: what opens is unloaded before it does, what closes
/// is loaded after. It lasts longer where forces need longer (kFastestLoad).

#include <locograph/planners/offline/motion/motion_loads.h>
#include <locograph/planners/offline/motion/segment_motion.h>
#include <locograph/planners/offline/motion/segment_record.h>
#include <locograph/planners/offline/stance/stance_path.h>

#include <Eigen/Core>
#include <span>
#include <vector>

namespace locograph {

struct LoadedSegment {
  SegmentMotion motion;
  std::vector<StanceWrenches> wrenches;  ///< along it; empty: unknown
};

class MotionAssembly {
 public:
  /// The task of the space must outlive it.
  explicit MotionAssembly(StanceSpace& space);

  /// Whether there are dwells, and wrenches along segments.
  bool bears_on() const { return task_.margin.dwell_s > 0.0; }
  /// Of the URDF's efforts, what a margin leaves of what the task allows; 0: no limits.
  double effort_scale(const ExecutionMargin& margin) const;

  /// Fills motion and records, as far as segments were found and loaded.
  void assemble(const StancePath& path, std::span<const LoadedSegment* const> segments,
                Motion& motion, std::vector<SegmentRecord>& records);

 private:
  void append(int stance, const Eigen::VectorXd& q, Eigen::VectorXd slope);
  void dwell(const Eigen::VectorXd& q, const StanceWrenches& from, const StanceWrenches& to,
             SegmentRecord& record);
  StanceWrenches at_rest(const Footing& footing, const Eigen::VectorXd& q);

  StanceSpace& space_;
  const Task& task_;
  RobotState state_;
  MotionLoads loads_;
  Motion* motion_ = nullptr;  ///< that is being put together
  double time_s_ = 0.0;       ///< where it has got to
};

}  // namespace locograph
