#pragma once
/// Whether a whole plan begins where its task does, and gets to its goals one after the other.
///
///     const PlannedTask task{.start = {.stance = on_the_floor}, .goals = {{.stance = on_top}}};
///     const PlanEnds ends = plan_ends(motion, task);
///     if (!ends.starts()) std::cerr << ends.off_start << '\n';
///
/// The start and the last goal are what the motion begins and ends with; the other goals are
/// reached in passing, in their order. A stance is one of these where it has the same end
/// effectors, by name, and each of them at its place, up to what a contact may be off
/// (limits.h): its position, and the directions that its kind holds; a wheel is locked, else it may
/// have rolled away from its place. That the robot is there, too,
/// is what the contacts of the motion are judged for. Any posture that holds the contacts will do.

#include <locograph/check/check_report.h>
#include <locograph/check/limits.h>
#include <locograph/check/motion.h>

#include <Eigen/Core>
#include <vector>

namespace locograph {

struct TaskPlace {
  Stance stance = {};  ///< all that touches; without contacts: of a drive, see base
  /// Where the base is, seen from above: x, y [m], heading [rad], full turns since the motion began
  /// counted: a drive round a circle is no rest.
  Eigen::Vector3d base = Eigen::Vector3d::Zero();
  double within_m = limits::kClosed_m, within_rad = limits::kClosed_rad;  ///< of base
};

struct PlannedTask {
  TaskPlace start;
  std::vector<TaskPlace> goals;
};

/// Throws Error for a stance of the motion that does not exist.
PlanEnds plan_ends(const Motion& motion, const PlannedTask& task);

/// Constraints of whole plans, in this order: `scenario_start` (count: 1 where it begins elsewhere)
/// and `scenario_goals` (count of those that are not reached). no_start, no_goals: why they are not
/// judged; empty: they are.
std::vector<Violation> end_violations(const Motion& motion, const PlanEnds& ends,
                                      const std::string& no_start, const std::string& no_goals);

}  // namespace locograph
