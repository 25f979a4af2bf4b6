#include <locograph/planners/online/ball_slip.h>
#include <locograph/plugins/rolling/edge_ball_rolling.h>

#include <algorithm>
#include <utility>

namespace locograph {

namespace {

bool is_as_planned(const OnlinePlan& plan, int first, int last) {
  int i = first;
  while (i <= last && plan.is_as_planned(i)) ++i;
  return i > last;
}

/// The most from the first configuration on [m].
double slip_m(const OnlinePlan& plan, int contact, int first, int last) {
  EdgeBallRolling rolling(contact, 1.0);
  rolling.bind(plan.graph().parameters());
  ConfigurationState before(plan.plan().robot), after(plan.plan().robot);
  Eigen::Vector2d slip = Eigen::Vector2d::Zero();
  double most_m = 0.0;
  before.update(plan.configuration(first).data());
  for (int i = first; i < last; ++i) {
    after.update(plan.configuration(i + 1).data());
    Eigen::Vector3d step;
    rolling.error(before, after, step);
    slip += step.head<2>();
    most_m = std::max(most_m, slip.norm());
    std::swap(before, after);
  }
  return most_m;
}

}  // namespace

std::optional<BallSlip> most_slipped(const OnlinePlan& plan, int configuration, double most_m) {
  std::optional<BallSlip> most;
  if (configuration == 0) return most;
  const auto& stance_from = plan.plan().stance_from;
  const StanceParameter& stance = *stance_from[static_cast<std::size_t>(configuration) - 1];
  for (std::size_t k = 0; k < stance.contacts.size(); ++k) {
    const Contact& contact = stance.contacts[k]->contact;
    if (!is_ball(contact.effector)) continue;
    const int number = stance.contact_numbers[k];
    const int first = held_since(stance_from, number, configuration);
    if (is_as_planned(plan, first, configuration)) continue;
    const double slipped_m = slip_m(plan, number, first, configuration);
    if (slipped_m > (most ? most->slip_m : most_m)) most = {contact.name(), slipped_m};
  }
  return most;
}

}  // namespace locograph
