#include <locograph/common/error.h>
#include <locograph/common/suggestion.h>
#include <locograph/planners/offline/stance/guided_planner.h>
#include <locograph/planners/offline/stance/rrt_planner.h>
#include <locograph/planners/offline/stance/stance_planners.h>

namespace locograph {

std::vector<std::string> stance_planner_names() {
  return {GuidedPlanner().name(), RrtPlanner().name()};
}

std::unique_ptr<const StancePlanner> make_stance_planner(const std::string& name) {
  if (name == GuidedPlanner().name()) return std::make_unique<GuidedPlanner>();
  if (name == RrtPlanner().name()) return std::make_unique<RrtPlanner>();
  const std::vector<std::string> names = stance_planner_names();
  throw Error("unknown planner '" + name + "'", "one of " + joined_names(names));
}

}  // namespace locograph
