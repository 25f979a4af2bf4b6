#include <locograph/common/check_option.h>
#include <locograph/planners/offline/motion/segment_planner.h>

namespace locograph {

void SegmentOptions::validate() const {
  termination.validate();
  check_option(max_states >= 1, "max_states", "1 or more");
}

SegmentPath SegmentPlanner::plan(SegmentSpace& space, const SegmentOptions& options) const {
  options.validate();
  const Stopwatch watch;
  SegmentPath path;
  if (search(space, options, path)) {
    path.status = PlannerStatus::kSolved;
    path.reason = "found";
  } else {
    path.waypoints.clear();
    if (const auto end = end_by(options.termination, path.statistics.iterations)) {
      path.status = end->status;
      path.reason = end->reason + (path.reason.empty() ? "" : "; " + path.reason);
    }
  }
  path.statistics.total_s = watch.seconds();
  return path;
}

}  // namespace locograph
