#include <locograph/planners/offline/stance/stance_planner.h>

namespace locograph {

StancePlan StancePlanner::plan(const Task& task, const StancePlannerOptions& options) const {
  const std::unique_ptr<StanceSearch> search = begin(task, options);
  while (search->next()) search->take();
  return search->result();
}

}  // namespace locograph
