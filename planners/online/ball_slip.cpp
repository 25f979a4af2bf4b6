#include <locograph/planners/online/ball_slip.h>
#include <locograph/plugins/rolling/edge_ball_rolling.h>

#include <algorithm>
#include <utility>

namespace locograph {

std::optional<BallSlip> most_slipped(const OnlinePlan& plan, int configuration, double most_m) {
  const Plan& whole = plan.plan();
  const auto held_from = [&](int i) -> const StanceParameter& {
    return *whole.stance_from[static_cast<std::size_t>(i)];
  };
  std::optional<BallSlip> most;
  if (configuration == 0) return most;
  ConfigurationState before(whole.robot), after(whole.robot);
  const StanceParameter& stance = held_from(configuration - 1);
  for (std::size_t k = 0; k < stance.contacts.size(); ++k) {
    const Contact& contact = stance.contacts[k]->contact;
    if (!is_ball(contact.effector)) continue;
    const int number = stance.contact_numbers[k];
    int first = configuration - 1;
    bool as_planned = plan.is_as_planned(configuration);
    for (; first > 0; --first) {
      as_planned = as_planned && plan.is_as_planned(first);
      const std::vector<int>& held = held_from(first - 1).contact_numbers;
      if (std::ranges::find(held, number) == held.end()) break;
    }
    if (as_planned) continue;
    EdgeBallRolling rolling(number, 1.0);
    rolling.bind(plan.graph().parameters());
    Eigen::Vector2d slip = Eigen::Vector2d::Zero();
    double worst_m = 0.0;
    before.update(plan.configuration(first).data());
    for (int i = first; i < configuration; ++i) {
      after.update(plan.configuration(i + 1).data());
      Eigen::Vector3d step;
      rolling.error(before, after, step);
      slip += step.head<2>();
      worst_m = std::max(worst_m, slip.norm());
      std::swap(before, after);
    }
    if (worst_m > most_m && (!most || worst_m > most->slip_m)) most = {contact.name(), worst_m};
  }
  return most;
}

}  // namespace locograph
