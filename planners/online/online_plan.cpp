#include <locograph/common/error.h>
#include <locograph/planners/online/heading.h>
#include <locograph/planners/online/online_plan.h>
#include <locograph/planners/plan/carried_wrenches.h>
#include <locograph/planners/plan/slope_limits.h>

#include <algorithm>
#include <utility>

namespace locograph {

bool rolls_on_wheels(const StanceParameter& stance) {
  return std::ranges::any_of(stance.wheels, [](const auto& wheel) { return !wheel.locked; });
}

OnlinePlan::OnlinePlan(Graph& graph) : graph_(graph), plan_(plan_of(graph)) {
  if (plan_.stances_only) throw Error("a plan of stances, which has no motions", "a whole plan");
  for (const auto& stance : plan_.stance_from) {
    if (!stance) throw Error("a configuration of the plan without a stance", "a stance for each");
    rolls_.push_back(rolls_on_wheels(*stance));
  }
  if (!plan_.world) throw Error("the plan has no world", "a PARAMS_WORLD line");
  world_ = plan_.world;
  planned_ = motion_of(graph, plan_);
  borne_at_.assign(plan_.index.configuration.size(), -1);
  for (int i = 0; i < size(); ++i) {
    for (const int slot : plan_.index.wrenches[static_cast<std::size_t>(i)]) {
      borne_at_[static_cast<std::size_t>(slot)] = i;
    }
  }
}

void OnlinePlan::show(std::shared_ptr<const WorldSnapshot> world) {
  world_ = std::make_shared<const WorldParameter>(std::move(world), plan_.world->ground_z_m);
}

Bindings OnlinePlan::bindings() const {
  Bindings bindings;
  bindings.set(plan_.world_number, world_);
  return bindings;
}

Eigen::Map<Eigen::VectorXd> OnlinePlan::configuration(int index) {
  return {graph_.state(slot(index)), graph_.state_size(slot(index))};
}

Eigen::Map<const Eigen::VectorXd> OnlinePlan::configuration(int index) const {
  return {std::as_const(graph_).state(slot(index)), graph_.state_size(slot(index))};
}

void OnlinePlan::move_to(int index, const Eigen::VectorXd& measured, int first) {
  Eigen::VectorXd off(robot().tangent_size()), step_back = off;
  Eigen::VectorXd was = configuration(index);
  robot().difference(was.data(), measured.data(), off.data());
  configuration(index) = measured;
  for (int i = index - 1; i >= first; --i) {
    robot().difference(was.data(), configuration(i).data(), step_back.data());
    was = configuration(i);
    const double* from = rolls(i) ? configuration(i + 1).data() : was.data();
    robot().integrate(from, rolls(i) ? step_back.data() : off.data(), configuration(i).data());
  }
}

void OnlinePlan::take_contacts(int index) {
  constexpr double kClosed_m = 1e-5;  // within what an edge tolerates
  RobotState state(robot());
  state.update(configuration(index).data());
  std::vector<int> taken;
  for (const int number : plan_.stance_from[static_cast<std::size_t>(index)]->contact_numbers) {
    const auto parameter = graph_.parameters().get<ContactParameter>(number);
    Contact contact = parameter->contact;
    if (contact.effector.kind == ContactKind::kGrasp || contact.bar || is_ball(contact.effector))
      continue;
    const ContactClosure& closure = parameter->closure;
    Eigen::VectorXd off(closure.rows());
    closure.error(state, off.data());
    const Eigen::Matrix3d axes = axes_in_world(contact);
    Eigen::Vector3d along = Eigen::Vector3d::Zero();
    for (int row = 0; row < closure.rows(); ++row) {
      const int held = closure.held()[static_cast<std::size_t>(row)];
      if (held < 2) along += off[row] * axes.col(held);
    }
    if (along.norm() <= kClosed_m || along.norm() > kElsewhere_m) continue;
    contact.position += along;
    graph_.replace_parameter(
        number, std::make_shared<const ContactParameter>(parameter->robot, parameter->robot_number,
                                                         contact, parameter->friction));
    taken.push_back(number);
  }
  if (taken.empty()) return;
  const auto has_taken = [&](const StanceParameter& stance) {
    return std::ranges::find_first_of(stance.contact_numbers, taken) !=
           stance.contact_numbers.end();
  };
  int replaced = kNoStance;
  for (int i = 0; i < size(); ++i) {
    auto& stance = plan_.stance_from[static_cast<std::size_t>(i)];
    if (!has_taken(*stance)) continue;
    const int number = graph_.vertex(VertexId<VertexConfiguration>{slot(i)}).stance_number;
    if (number != replaced) {
      graph_.replace_parameter(number, std::make_shared<const StanceParameter>(
                                           graph_.parameters(), stance->contact_numbers));
      replaced = number;
    }
    stance = graph_.parameters().get<StanceParameter>(number);
  }
}

void OnlinePlan::overwrite(int first, std::span<const Eigen::VectorXd> configurations) {
  int index = first;
  for (const Eigen::VectorXd& q : configurations) {
    if (!is_fixed(index)) configuration(index) = q;
    ++index;
  }
}

double OnlinePlan::time_s(int index) const {
  return graph_.vertex(VertexId<VertexConfiguration>{slot(index)}).time_s;
}

bool OnlinePlan::is_as_planned(int index) const {
  constexpr double kSame = 1e-9;  // m, rad
  const Eigen::VectorXd& planned = planned_.configurations[static_cast<std::size_t>(index)];
  return (configuration(index) - planned).lpNorm<Eigen::Infinity>() <= kSame;
}

void OnlinePlan::follow_moved(int first, int last) {
  bool steps = false;
  for (int i = first; i <= last; ++i) {
    Eigen::VectorXd& slopes = graph_.vertex(VertexId<VertexConfiguration>{slot(i)}).slopes;
    if (rolls(i)) {
      if (!is_as_planned(i)) slopes.resize(0);
      continue;
    }
    steps = true;
    slopes =
        planned_.slopes.empty() ? Eigen::VectorXd() : planned_.slopes[static_cast<std::size_t>(i)];
  }
  if (!steps) return;
  carry_slopes(planned_, plan_, graph_, {first, last});
  carry_wrenches(planned_, plan_, graph_, {first - 1, last});
}

double OnlinePlan::behind_m(int index) const {
  const Eigen::VectorXd& planned = planned_.configurations[static_cast<std::size_t>(index)];
  const Eigen::Vector3d behind = planned.head<3>() - configuration(index).head<3>();
  const Eigen::Vector3d left = left_of(planned.data());
  return behind.dot(left.cross(Eigen::Vector3d::UnitZ()));
}

int OnlinePlan::first_index_on(int slot) const {
  if (index_of(slot) >= 0) return index_of(slot);
  if (borne_at(slot) >= 0) return borne_at(slot);
  int first = size();
  for (const int e : graph_.incident_edges(slot)) {
    for (const int v : graph_.edge_vertices(e)) {
      if (index_of(v) >= 0) first = std::min(first, index_of(v));
    }
  }
  return first < size() ? first : -1;
}

}  // namespace locograph
