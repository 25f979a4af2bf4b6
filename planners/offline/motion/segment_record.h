#pragma once
/// What a plan tells of each of its stances: where it is in the motion, who planned it, and how
/// long that took.

#include <optional>
#include <string>

namespace locograph {

/// In the place of a segment planner: the robot stands at its goal while forces go over.
inline constexpr char kDwell[] = "dwell";

/// What became of one stance of the plan.
struct SegmentRecord {
  int stance = 0;           ///< of Motion::stances
  int first = 0, last = 0;  ///< vertices of the motion
  double duration_s = 0.0;
  std::string planner;  ///< that solved it
  double path_s = 0.0;  ///< all planners that tried
  double timing_s = 0.0;
  double length = 0.0,
         straight = 0.0;          ///< of the path and of the straight way, SegmentSpace::distance
  std::optional<double> clear_m;  ///< as SegmentMotion::clear_m
};

}  // namespace locograph
