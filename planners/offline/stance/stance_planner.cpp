#include <locograph/planners/offline/stance/stance_planner.h>

namespace locograph {

StancePlan StancePlanner::plan(const StanceProblem& problem,
                               const StancePlannerOptions& options) const {
  const std::unique_ptr<StanceSearch> search = begin(problem, options);
  while (search->next()) search->take();
  return search->result();
}

}  // namespace locograph
