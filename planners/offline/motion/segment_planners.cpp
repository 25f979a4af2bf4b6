#include <locograph/common/error.h>
#include <locograph/common/suggestion.h>
#include <locograph/planners/offline/motion/interpolation.h>
#include <locograph/planners/offline/motion/ompl_planners.h>
#include <locograph/planners/offline/motion/optimisation.h>
#include <locograph/planners/offline/motion/segment_planners.h>

#include <array>

namespace locograph {
namespace {

constexpr std::array kMakersOfSegmentPlanners = {&make_interpolation, &make_optimisation,
                                                 &make_rrt_connect, &make_atlas_rrt_star};

}  // namespace

const std::vector<std::string>& segment_planner_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto make : kMakersOfSegmentPlanners) all.push_back(make()->name());
    return all;
  }();
  return names;
}

std::unique_ptr<SegmentPlanner> make_segment_planner(const std::string& name) {
  for (const auto make : kMakersOfSegmentPlanners) {
    std::unique_ptr<SegmentPlanner> planner = make();
    if (planner->name() == name) return planner;
  }
  throw Error("unknown planner of segments '" + name + "'",
              "one of " + joined_names(segment_planner_names()));
}

}  // namespace locograph
