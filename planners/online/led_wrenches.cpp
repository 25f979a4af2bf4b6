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

/// Least wrenches with as much of the margin as there was at every configuration so far.
class Least {
 public:
  Least(const Robot& robot, const Stance& stance) : robot_(robot) {
    for (const Contact& contact : stance.contacts) contacts_.push_back({contact});
    ask_for(0);
  }

  /// Null: none hold, and the others keep their margin.
  const StanceWrenches* solve(const RobotState& state, const Eigen::VectorXd& asked) {
    const std::size_t before = part_;
    while (!least_->solve(state, asked)) {
      if (part_ + 1 == kPartsOfMargin.size()) {
        if (part_ != before) ask_for(before);
        return nullptr;
      }
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

/// Wrenches at the contacts of a stance as the numbers of a vertex, which keeps those of others.
Eigen::VectorXd components_of(const StanceParameter& stance, const StanceWrenches& wrenches,
                              const VertexWrenches& vertex) {
  Eigen::VectorXd components = vertex.state;
  Eigen::Index at = 0;
  for (std::size_t c = 0; c < vertex.contact_numbers.size(); ++c) {
    const auto found = std::ranges::find(stance.contact_numbers, vertex.contact_numbers[c]);
    const bool known = found != stance.contact_numbers.end();
    const auto k = static_cast<std::size_t>(found - stance.contact_numbers.begin());
    for (const int component : (*vertex.contacts)[c]->cone->components()) {
      if (known) components[at] = wrenches[k][component];
      ++at;
    }
  }
  return components;
}

/// Whether every contact can bear them.
bool inside_cones(const VertexWrenches& vertex, const Eigen::VectorXd& components) {
  const double* w = components.data();
  for (const auto& contact : *vertex.contacts) {
    const auto count = static_cast<Eigen::Index>(contact->cone->components().size());
    for (int i = 0; i < contact->cone->rows(); ++i) {
      const WrenchRow row = contact->cone->row(i, w);
      const Eigen::Map<const Eigen::VectorXd> of(w, count);
      if (row.gradient.head(count).dot(of) + row.offset > 0.0) return false;
    }
    w += count;
  }
  return true;
}

/// Moves a vertex by a share towards what its contacts can bear, and further as long as they cannot
/// bear what comes of it.
void mix(const Eigen::VectorXd& least, double share, VertexWrenches& vertex) {
  constexpr int kHalved = 20;
  const Eigen::VectorXd way = least - vertex.state;
  const auto bears = [&](double part) { return inside_cones(vertex, vertex.state + part * way); };
  if (!bears(share)) {
    double most = 1.0;
    for (int k = 0; k < kHalved; ++k) {
      const double middle = 0.5 * (share + most);
      (bears(middle) ? most : share) = middle;
    }
    share = most;
  }
  vertex.state += share * way;
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
  const auto solve = [&](std::size_t i) {
    const CurvePoint point = curve.through_vertex(static_cast<int>(i));
    state.update(motion.configurations[i].data());
    dynamics.inverse_dynamics(state, point.velocity, point.acceleration, {}, asked);
    return least.solve(state, asked);
  };
  const auto count = static_cast<std::size_t>(range.last - range.first);
  // All with the part of the margin that there is everywhere: forces jump where it changes.
  for (std::size_t i = 0; i < count; ++i) solve(i);
  for (std::size_t i = 0; i < count; ++i) {
    const StanceWrenches* wrenches = solve(i);
    if (wrenches == nullptr) continue;
    const double share = share_left((motion.time_s[i] - begin_s) / duration_s);
    for (const int slot : plan.index.wrenches[first + i]) {
      VertexWrenches& vertex = graph.vertex(VertexId<VertexWrenches>{slot});
      mix(components_of(stance, *wrenches, vertex), share, vertex);
    }
  }
}

}  // namespace locograph
