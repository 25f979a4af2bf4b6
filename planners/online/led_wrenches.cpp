#include <locograph/check/motion_curve.h>
#include <locograph/planners/balance/least_wrenches.h>
#include <locograph/planners/balance/margin_contacts.h>
#include <locograph/planners/online/led_wrenches.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>
#include <locograph/robots/dynamics.h>
#include <locograph/robots/statics.h>

#include <algorithm>
#include <optional>

namespace locograph {
namespace {

/// Least wrenches with as much of the margin as there is, more at one configuration than at another
/// one only where it has to be.
class Least {
 public:
  Least(const Robot& robot, const Stance& stance) : robot_(robot) {
    for (const Contact& contact : stance.contacts) contacts_.push_back({contact});
    ask_for(0);
  }

  /// Null: none hold.
  const StanceWrenches* solve(const RobotState& state, const Eigen::VectorXd& asked) {
    while (!least_->solve(state, asked)) {
      if (part_ + 1 == kPartsOfMargin.size()) return nullptr;
      ask_for(part_ + 1);
    }
    return &least_->wrenches();
  }

 private:
  void ask_for(std::size_t part) {
    part_ = part;
    ExecutionMargin margin = ExecutionMargin().scaled(kPartsOfMargin[part]);
    margin.least_force = 0.0;  // at a change of contacts there is none
    const double weight_N = robot_.total_mass() * standard_gravity().norm();
    least_.emplace(robot_, with_margin(contacts_, margin, weight_N), margin.torque);
  }

  const Robot& robot_;
  std::vector<BearingContact> contacts_;
  std::optional<LeastWrenches> least_;
  std::size_t part_ = 0;
};

/// Moves a vertex by a share towards wrenches at the contacts of a stance.
void mix(const StanceParameter& stance, const StanceWrenches& wrenches, double share,
         VertexWrenches& vertex) {
  Eigen::Index at = 0;
  for (std::size_t c = 0; c < vertex.contact_numbers.size(); ++c) {
    const auto found = std::ranges::find(stance.contact_numbers, vertex.contact_numbers[c]);
    const bool known = found != stance.contact_numbers.end();
    for (const int component : (*vertex.contacts)[c]->cone->components()) {
      double& is = vertex.state[at++];
      if (!known) continue;
      const auto k = static_cast<std::size_t>(found - stance.contact_numbers.begin());
      is += share * (wrenches[k][component] - is);
    }
  }
}

}  // namespace

double share_left(double time_share) {
  const double t = std::clamp(time_share, 0.0, 1.0);
  return 1.0 - t * t * t * (10.0 - t * (15.0 - 6.0 * t));
}

void lead_wrenches(const Plan& plan, Graph& graph, const PlanRange& range) {
  if (plan.stances_only || !plan.states_wrenches || range.last <= range.first) return;
  const auto first = static_cast<std::size_t>(range.first);
  const StanceParameter& stance = *plan.stance_from[first];
  const Robot& robot = *plan.robot->robot;
  const Motion motion = motion_of(graph, plan, range.first, range.last);
  const MotionCurve curve(robot, motion);
  const double begin_s = motion.time_s.front(), duration_s = motion.time_s.back() - begin_s;
  if (std::ranges::none_of(stance.stance.contacts, &Contact::bears_load)) return;
  Least least(robot, stance.stance);
  RobotState state(robot);
  RobotDynamics dynamics(robot);
  Eigen::VectorXd asked(robot.tangent_size());
  for (int k = 0; k < range.last - range.first; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const CurvePoint point = curve.through_vertex(k);
    state.update(motion.configurations[i].data());
    dynamics.inverse_dynamics(state, point.velocity, point.acceleration, {}, asked);
    const StanceWrenches* wrenches = least.solve(state, asked);
    if (wrenches == nullptr) continue;
    const double share = share_left((motion.time_s[i] - begin_s) / duration_s);
    for (const int slot : plan.index.wrenches[first + i]) {
      mix(stance, *wrenches, share, graph.vertex(VertexId<VertexWrenches>{slot}));
    }
  }
}

}  // namespace locograph
