#include "crossing_cases.h"

#include <locograph/check/judge.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>

namespace locograph {
namespace {

constexpr double kSpeed_m_s = 0.5, kHalfWay_m = 3.0, kRadius_m = 0.25, kHeight_m = 1.75;

Obstacle person(const Crossing& crossing, double meets_at_s) {
  Obstacle walker;
  walker.name = "person";
  walker.shape = Obstacle::Shape::kCylinder;
  walker.size = {kRadius_m, kHeight_m, 0.0};
  const double side = crossing.from_left ? 1.0 : -1.0;
  KeyFrame start, end;
  start.time_s = meets_at_s - kHalfWay_m / kSpeed_m_s;
  end.time_s = meets_at_s + kHalfWay_m / kSpeed_m_s;
  start.pose.translation() << crossing.x_m, side * kHalfWay_m, 0.5 * kHeight_m;
  end.pose.translation() << crossing.x_m, -side * kHalfWay_m, 0.5 * kHeight_m;
  walker.world_from_obstacle = start.pose;
  walker.motion = {start, end};
  return walker;
}

/// Of a window: the plan goes on before and after it.
CheckOptions window_options(const Scenario& scenario) {
  CheckOptions options;
  options.known = scenario.end_effectors;
  options.base_linear_m_s = scenario.limits.base_linear_m_s;
  options.base_angular_rad_s = scenario.limits.base_angular_rad_s;
  options.joint_acceleration_rad_s2 = scenario.limits.joint_acceleration_rad_s2;
  options.starts_at_rest = options.ends_at_rest = false;
  return options;
}

/// From the executed configuration to the last one of the window.
Motion window_of(const Graph& graph, const Plan& plan, const CycleReport& cycle) {
  const auto first = static_cast<std::size_t>(cycle.executed);
  const std::size_t end = first + static_cast<std::size_t>(cycle.window) + 1;
  Plan window = plan;
  window.slots = {plan.slots.begin() + first, plan.slots.begin() + end};
  window.stance_from = {plan.stance_from.begin() + first, plan.stance_from.begin() + end};
  return motion_of(graph, window);
}

std::string first_refusal(const CheckReport& report) {
  for (const Violation& v : report.violations) {
    if (v.violated) return violation_text(v);
  }
  return violation_text(report.worst());
}

}  // namespace

std::vector<Crossing> crossings(int count) {
  constexpr double kPlaces_m[] = {1.2, 1.6, 2.0, 2.4, 2.8, 3.2};
  constexpr double kDelays_s[] = {0.0, -3.0, 3.0, 6.0};
  std::vector<Crossing> all;
  for (int i = 0; i < count; ++i) {
    all.push_back({kPlaces_m[i % 6], kDelays_s[i / 6 % 4], (i + i / 6) % 2 == 0});
  }
  return all;
}

CrossingResult run_crossing(const Scenario& scenario, const Crossing& crossing,
                            const CrossingOptions& options) {
  Graph graph = plan_wheeled_drive(scenario);
  LocalPlanner planner(graph, options.planner);
  const Plan& plan = planner.plan();
  const double meets_at_s = crossing.x_m / scenario.drive->speed_m_s + crossing.delay_s;
  const std::vector<Obstacle> obstacles = {person(crossing, meets_at_s)};
  WorldDistance seen;
  seen.obstacles = obstacles;
  planner.show(seen);
  World world = world_of(scenario);
  world.obstacles = obstacles;
  const Judge judge(plan.robot->robot, world);
  const CheckOptions check = window_options(scenario);

  CrossingResult result;
  for (int executed = 0; executed + 1 < planner.plan_size(); ++executed) {
    const CycleReport cycle = planner.cycle(executed);
    if (executed % options.every == 0) {
      const CheckReport judged = judge.check(window_of(graph, plan, cycle), check);
      ++result.windows;
      result.called_feasible += cycle.feasible ? 1 : 0;
      result.judged_feasible += judged.feasible ? 1 : 0;
      result.agreed_feasible += cycle.feasible && judged.feasible ? 1 : 0;
      if (cycle.feasible && !judged.feasible) {
        ++result.wrongly_feasible;
        if (result.refused.empty()) result.refused = first_refusal(judged);
      }
    }
    if (!cycle.next_feasible) return result;
    ++result.steps;
  }
  result.arrived = true;
  return result;
}

}  // namespace locograph
