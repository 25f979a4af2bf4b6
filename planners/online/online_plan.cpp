#include <locograph/common/error.h>
#include <locograph/planners/online/heading.h>
#include <locograph/planners/online/led_wrenches.h>
#include <locograph/planners/online/online_plan.h>
#include <locograph/planners/plan/carried_wrenches.h>
#include <locograph/planners/plan/slope_limits.h>
#include <locograph/plugins/configuration/segment_parameter.h>
#include <locograph/plugins/plan_tracking/edge_plan_tracking.h>
#include <locograph/plugins/velocity_tracking/edge_velocity_tracking.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
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
  show(plan_.world);
  planned_ = motion_of(graph, plan_);
  borne_at_.assign(plan_.index.configuration.size(), -1);
  for (int i = 0; i < size(); ++i) {
    for (const int slot : plan_.index.wrenches[static_cast<std::size_t>(i)]) {
      borne_at_[static_cast<std::size_t>(slot)] = i;
    }
  }
}

void OnlinePlan::show(std::shared_ptr<const WorldParameter> world) {
  world_ = std::move(world);
  bindings_.set(plan_.world_number, world_);
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
  ++revision_;
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
  const auto at = static_cast<std::size_t>(index);
  const Eigen::VectorXd& planned = planned_.configurations[at];
  const Eigen::Map<const Eigen::VectorXd> now = configuration(index);
  const auto rolls = [&](Eigen::Index coordinate) {
    const auto joint = coordinate - robot().base_configuration_size();
    return std::ranges::any_of(plan_.stance_from[at]->wheels, [&](const auto& wheel) {
      return !wheel.locked && wheel.wheel.joint == joint;
    });
  };
  for (Eigen::Index c = 0; c < now.size(); ++c) {
    if (std::abs(now[c] - planned[c]) > kSame && !rolls(c)) return false;
  }
  return true;
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
  const auto moved = [this](int i) { return moved_around(planned_, plan_, graph_, i); };
  for (int i = first; i <= last; ++i) {
    if (!rolls(i) && !rolls(i - 1) && !is_as_planned(i) && !is_fixed(i)) lift_out(i);
  }
  PlanRange range = {first - 1, last};
  while (range.first <= range.last && !moved(range.first)) ++range.first;
  while (range.last > range.first && !moved(range.last)) --range.last;
  if (range.first > range.last) return;
  carry_slopes(planned_, plan_, graph_, {std::max(first, range.first), range.last});
  carry_wrenches(planned_, plan_, graph_, range);
}

void OnlinePlan::lift_out(int index) {
  constexpr double kMost_m = 1e-4, kClear_m = 1e-7;
  const auto stance_at = [this](int i) -> const StanceParameter& {
    return *plan_.stance_from[static_cast<std::size_t>(i)];
  };
  if (!robot().floating_base()) return;
  const StanceParameter& here = stance_at(index);
  RobotState state(robot());
  Eigen::VectorXd off;
  const auto lift = [&](const std::vector<int>& numbers, const std::vector<int>& held) {
    for (const int number : numbers) {
      if (std::ranges::find(held, number) != held.end()) continue;
      const auto parameter = graph_.parameters().get<ContactParameter>(number);
      if (parameter->contact.effector.kind == ContactKind::kGrasp || parameter->contact.bar)
        continue;
      state.update(configuration(index).data());
      off.resize(parameter->closure.rows());
      parameter->closure.error(state, off.data());
      for (int row = 0; row < parameter->closure.rows(); ++row) {
        if (parameter->closure.held()[static_cast<std::size_t>(row)] != 2) continue;
        if (!(off[row] < 0.0 && off[row] > -kMost_m)) continue;
        const Eigen::Vector3d normal = axes_in_world(parameter->contact).col(2);
        configuration(index).head<3>() += (kClear_m - off[row]) * normal;
      }
    }
  };
  int before = index, after = index;
  while (before > 0 && &stance_at(before) == &here) --before;
  while (after < last() && &stance_at(after) == &here) ++after;
  lift(stance_at(before).contact_numbers, here.contact_numbers);
  lift(stance_at(after).contact_numbers, here.contact_numbers);
  if (before + 1 == index) lift(here.contact_numbers, stance_at(before).contact_numbers);
}

void OnlinePlan::slow_down(int from, int to, double duration_s) {
  ++revision_;
  moved_m_ = std::numeric_limits<double>::infinity();
  const int steps = to - from;
  std::vector<double> step_s, faster(static_cast<std::size_t>(steps) + 1);
  for (int i = from; i < to; ++i) step_s.push_back(time_s(i + 1) - time_s(i));
  const auto slowed = [&](std::size_t k) { return 2.0 * step_s[k] / (faster[k] + faster[k + 1]); };
  // As fast as 1 - a sin^2(pi x) over the share x of the steps.
  double least = 0.0, most = 0.999;
  constexpr int kHalved = 40;
  for (int halved = 0; halved < kHalved; ++halved) {
    const double a = 0.5 * (least + most);
    for (int k = 0; k <= steps; ++k) {
      const double sine = std::sin(std::numbers::pi * k / steps);
      faster[static_cast<std::size_t>(k)] = 1.0 - a * sine * sine;
    }
    double all_s = 0.0;
    for (std::size_t k = 0; k < step_s.size(); ++k) all_s += slowed(k);
    (all_s < duration_s ? least : most) = a;
  }
  const double was_s = time_s(to);
  double at_s = time_s(from);
  const auto set_time = [&](int i, double time_s, double scale) {
    VertexConfiguration& vertex = graph_.vertex(VertexId<VertexConfiguration>{slot(i)});
    const auto at = static_cast<std::size_t>(i);
    vertex.time_s = planned_.time_s[at] = time_s;
    vertex.slopes *= scale;
    if (!planned_.slopes.empty()) planned_.slopes[at] *= scale;
  };
  for (std::size_t k = 0; k < step_s.size(); ++k) {
    at_s += slowed(k);
    set_time(from + 1 + static_cast<int>(k), at_s, faster[k + 1]);
  }
  for (int i = to + 1; i < size(); ++i) set_time(i, time_s(i) + at_s - was_s, 1.0);
  follow_times();
}

/// Segments begin and end with their configurations.
void OnlinePlan::follow_times() {
  for (const int number : graph_.parameters().numbers_of<SegmentParameter>()) {
    const auto given = graph_.parameters().get<SegmentParameter>(number);
    PlanSegment& segment = plan_.segments.at(static_cast<std::size_t>(given->segment));
    const auto moved = std::make_shared<SegmentParameter>(*given);
    moved->from_s = time_s(segment.first);
    moved->duration_s = segment.duration_s = time_s(segment.last) - moved->from_s;
    graph_.parameters().replace(number, moved);
  }
}

void OnlinePlan::go_as_led(const PlanRange& range, int back) {
  // The configuration after the range has moved, and the one after that has it beside it.
  const int moved = std::min(range.last + 2, last());
  if (!planned_.slopes.empty()) {
    carry_slopes(planned_, plan_, graph_, {range.first, moved}, Rests::kMove);
  }
  balance_wrenches(plan_, graph_, range);
  const auto& stance_from = plan_.stance_from;
  const auto stance = stance_from.begin() + range.first;
  const auto change = std::find_if(stance, stance_from.end(), [&](const auto& there) {
    return there->contact_numbers != (*stance)->contact_numbers;
  });
  lead_wrenches(plan_, graph_,
                {range.first, std::min(back, static_cast<int>(change - stance_from.begin()))});
  const Motion led = motion_of(graph_, plan_, range.first, moved);
  double most_m = 0.0;
  for (int i = range.first; i <= moved; ++i) {
    const auto to = static_cast<std::size_t>(i), k = static_cast<std::size_t>(i - range.first);
    const Eigen::VectorXd by = led.configurations[k] - planned_.configurations[to];
    most_m = std::max(most_m, by.lpNorm<Eigen::Infinity>());
    planned_.configurations[to] = led.configurations[k];
    if (!planned_.slopes.empty()) planned_.slopes[to] = led.slopes[k];
    if (!planned_.wrenches.empty()) planned_.wrenches[to] = led.wrenches[k];
  }
  moved_m_ += most_m;
}

void OnlinePlan::move_planned(int first, std::span<const Eigen::VectorXd> by) {
  ++revision_;
  if (came_.empty()) came_ = planned_.configurations;
  Eigen::VectorXd was_before, was, step(robot().tangent_size()), moved_step = step;
  double most_m = 0.0;
  int i = first;
  for (const Eigen::VectorXd& tangent : by) {
    most_m = std::max(most_m, tangent.head<6>().lpNorm<Eigen::Infinity>());
    Eigen::VectorXd& planned = planned_.configurations[static_cast<std::size_t>(i)];
    was_before.swap(was);
    was = planned;
    robot().integrate(was.data(), tangent.data(), planned.data());
    if (i > first) {
      const auto& before = planned_.configurations[static_cast<std::size_t>(i) - 1];
      robot().difference(was_before.data(), was.data(), step.data());
      robot().difference(before.data(), planned.data(), moved_step.data());
    }
    for (const int e : graph_.incident_edges(slot(i))) {
      if (edge_is<EdgePlanTracking>(graph_, e)) {
        Eigen::VectorXd& reference = graph_.edge<EdgePlanTracking>(EdgeId{e}).reference;
        const Eigen::VectorXd tracked = reference;
        robot().integrate(tracked.data(), tangent.data(), reference.data());
      } else if (edge_is<EdgeVelocityTracking>(graph_, e)) {
        auto& edge = graph_.edge<EdgeVelocityTracking>(EdgeId{e});
        if (i > first && edge.vertices[1] == slot(i)) edge.step += moved_step - step;
      }
    }
    ++i;
  }
  moved_m_ += most_m;
}

bool OnlinePlan::forget_moved() {
  constexpr double kMoved_m = 5e-3;
  if (moved_m_ < kMoved_m) return false;
  moved_m_ = 0.0;
  return true;
}

double OnlinePlan::behind_m(int index) const {
  constexpr double kLeast_m = 1e-6;
  const auto at = static_cast<std::size_t>(index);
  const Eigen::VectorXd& planned = planned_.configurations[at];
  const Eigen::Vector3d behind = planned.head<3>() - configuration(index).head<3>();
  Eigen::Vector3d way = left_of(planned.data()).cross(Eigen::Vector3d::UnitZ());
  if (index > 0) {  // wherever it heads
    Eigen::Vector3d moved = (planned - planned_.configurations[at - 1]).head<3>();
    moved.z() = 0.0;
    if (moved.norm() > kLeast_m) way = moved.normalized();
  }
  return behind.dot(way);
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
