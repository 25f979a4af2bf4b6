#include <locograph/planners/balance/margin_contacts.h>
#include <locograph/planners/offline/stance/given_margins.h>
#include <locograph/planners/offline/stance/stance_space.h>
#include <locograph/robots/rolling_ball.h>

#include <algorithm>

namespace locograph {

std::vector<GivenMargin> given_margins(const Task& task, const StancePlan& plan) {
  std::vector<GivenMargin> result;
  if (task.margin == ExecutionMargin::none() || plan.configurations.empty()) return result;
  const StancePlannerOptions options;
  StanceSpace space(task, options);
  RobotState state(*task.robot->robot);
  const auto add = [&](std::string where, std::size_t i) {
    state.update(plan.configurations[i].data());
    const Eigen::Vector2d centre = state.center_of_mass().head<2>();
    const std::vector<BearingContact> contacts =
        rolled_to(state, space.bearing_contacts(space.footing(plan.stances[i])));
    GivenMargin given{std::move(where), 0.0, task.margin};
    given.share = share_of_margin(state.robot().total_mass(), contacts, task.margin, {&centre, 1});
    const ExecutionMargin had = task.margin.scaled(given.share);
    given.margin.friction = had.friction;
    given.margin.area = had.area;
    given.margin.least_force = had.least_force;
    result.push_back(std::move(given));
  };
  add("start", 0);
  std::size_t i = 1;
  for (int g = 0; g < plan.goals_reached; ++g) {
    const Footing goal = space.footing(task.goals[static_cast<std::size_t>(g)]);
    while (i < plan.stances.size() && space.footing(plan.stances[i]) != goal) ++i;
    if (i == plan.stances.size()) break;
    add("goal " + std::to_string(g + 1), i);
  }
  return result;
}

}  // namespace locograph
