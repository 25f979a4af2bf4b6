#include <locograph/common/ranges.h>
#include <locograph/planners/online/braking.h>
#include <locograph/planners/plan/carried_wrenches.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace locograph {
namespace {

/// Motions that come to rest within one to so many steps are tried: on wheels, and on legs, whose
/// steps are short.
constexpr int kMostBrakingSteps = 12;
constexpr int kFewestBrakingStepsOfLegs = 4, kMostBrakingStepsOfLegs = 64;

}  // namespace

Braking::Braking(Graph& graph, const OnlinePlan& plan,
                 std::function<CheckReport(const Motion&)> verify)
    : graph_(graph), plan_(plan), verify_(std::move(verify)) {}

VertexConfiguration& Braking::vertex(int i) const {
  return graph_.vertex(VertexId<VertexConfiguration>{plan_.slot(i)});
}

const std::vector<int>& Braking::wrenches_at(int i) const {
  return plan_.plan().index.wrenches[static_cast<std::size_t>(i)];
}

bool Braking::rests(int i) const {
  return vertex(i).slopes.size() > 0 && vertex(i).slopes.isZero();
}

int Braking::last_rest_before(int i) const {
  do --i;
  while (i > 0 && !rests(i));
  return i;
}

Braking::Passing Braking::passing(int i) const {
  Passing now{vertex(i).time_s, vertex(i).slopes, {}};
  for (const int slot : wrenches_at(i)) {
    now.wrenches.emplace_back(
        Eigen::Map<const Eigen::VectorXd>(graph_.state(slot), graph_.state_size(slot)));
  }
  return now;
}

void Braking::restore(int i, const Passing& before) {
  vertex(i).time_s = before.time_s;
  vertex(i).slopes = before.slopes;
  for (std::size_t k = 0; k < before.wrenches.size(); ++k) {
    std::ranges::copy(before.wrenches[k], graph_.state(wrenches_at(i)[k]));
  }
}

/// Lets the robot come to rest at a configuration, over some steps. On legs its speed goes with the
/// share x of the way that it has gone as (1 - x²)^(2/3), so that forces do not jump: what is left
/// of the way in the last step goes with the third power of what is left of its time.
void Braking::brake(int last, int steps, bool wheels) {
  double time_s = vertex(last - steps).time_s, before_s = time_s, faster = 1.0;
  for (int i = last - steps + 1; i <= last; ++i) {
    const double left = static_cast<double>(last - i) / steps, x = 1.0 - left;
    const double slower = wheels ? std::sqrt(left) : std::pow(1.0 - x * x, 2.0 / 3.0);
    const double duration_s = vertex(i).time_s - before_s;
    before_s = vertex(i).time_s;
    time_s += duration_s * (wheels || i < last ? 2.0 / (faster + slower) : 3.0 / faster);
    vertex(i).time_s = time_s;
    vertex(i).slopes *= slower;
    faster = slower;
  }
  if (wheels) return;
  balance_wrenches(part(0, last), graph_, {last - steps, last - 1});
  stay(last);
}

/// For balance_wrenches().
Plan Braking::part(int first, int last) const {
  const Plan& whole = plan_.plan();
  const auto part_of = [&](const auto& all) {
    return std::decay_t<decltype(all)>(all.begin() + first, all.begin() + last + 1);
  };
  Plan plan;
  plan.robot = whole.robot;
  plan.states_wrenches = whole.states_wrenches;
  plan.slots = part_of(whole.slots);
  plan.stance_from = part_of(whole.stance_from);
  plan.index.wrenches = part_of(whole.index.wrenches);
  return plan;
}

/// Whether the robot may stand there for kStands_s, for the judge and for the window's edges: it
/// may where nothing is known to change.
bool Braking::may_stay(int at) const {
  if (!stays_ || !verify_) return true;
  constexpr double kStep_s = 0.1, kApart_m = 5e-3;
  ChangingObstacles obstacles(*plan_.plan().robot, plan_.world().world());
  if (!obstacles.any()) return true;
  const double time_s = vertex(at).time_s;
  const std::vector<Eigen::Vector3d> centres = obstacles.centres(vertex(at).state);
  for (double after_s = 0.0; after_s <= kStands_s; after_s += kStep_s) {
    if (!obstacles.keep_away(centres, time_s + after_s, kApart_m)) return false;
  }
  Motion still = motion_of(graph_, plan_.plan(), at, at);
  still.wrenches.clear();
  still.configurations.push_back(still.configurations.front());
  still.slopes.assign(2, Eigen::VectorXd::Zero(plan_.plan().robot->robot->tangent_size()));
  still.stance_from.push_back(still.stance_from.front());
  still.time_s.push_back(still.time_s.front() + kStands_s);
  return verify_(still).feasible;
}

std::optional<int> Braking::come_to_rest(int executed, int furthest, int carried_out) {
  for (stays_ = true;; stays_ = false) {
    const std::optional<int> rest = find_rest(executed, furthest, carried_out);
    if (rest || !stays_) return rest;
  }
}

std::optional<int> Braking::find_rest(int executed, int furthest, int carried_out) {
  for (int steps = kFewestBrakingStepsOfLegs; executed + steps <= furthest; steps += steps / 2) {
    if (rests(executed) && may_stay(executed)) return stay(executed);
    if (executed <= carried_out || last_rest_before(executed + steps) > executed) break;
    const int last = executed + steps;
    if (may_stay(last) && comes_to_rest(last, steps, false)) return last;
  }
  for (int last = executed; last > 0 && last >= carried_out; --last) {
    if (!may_stay(last)) continue;
    if (rests(last)) return stay(last);
    const bool wheels = plan_.rolls(last - 1);
    const int free = last - std::max(carried_out + 1, 0);
    const int most = wheels
                         ? std::min(free, kMostBrakingSteps)
                         : std::min({free, kMostBrakingStepsOfLegs, last - last_rest_before(last)});
    for (int steps = wheels ? 1 : kFewestBrakingStepsOfLegs; steps <= most;
         steps = wheels ? steps + 1 : 2 * steps) {
      if (comes_to_rest(last, steps, wheels)) return last;
    }
  }
  if (carried_out > 0 || !may_stay(0)) return {};
  return 0;
}

/// What bears a configuration at which the robot rests does not move it.
int Braking::stay(int at) {
  balance_wrenches(part(at, at), graph_, {0, 0});
  return at;
}

/// Whether the judge lets the robot brake so; else nothing changes.
bool Braking::comes_to_rest(int last, int steps, bool wheels) {
  std::vector<Passing> moving;
  for (int i = last - steps; i <= last; ++i) moving.push_back(passing(i));
  brake(last, steps, wheels);
  // Where braking begins forces may jump.
  const int first = wheels ? last - steps : std::max(0, last - steps - 2);
  if (vertex(last).time_s <= ranges::kTime_s &&
      (!verify_ || verify_(motion_of(graph_, plan_.plan(), first, last)).feasible)) {
    return true;
  }
  for (int i = 0; i <= steps; ++i) restore(last - steps + i, moving[static_cast<std::size_t>(i)]);
  return false;
}

}  // namespace locograph
