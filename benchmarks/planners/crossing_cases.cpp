#include "crossing_cases.h"

#include <locograph/planners/offline/wheeled_drive.h>
#include <locograph/planners/plan/feasibility_checker.h>

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

CollisionWorldOptions collision_options(const WheelsParameter& wheels) {
  CollisionWorldOptions options;
  for (const Wheel& wheel : wheels.wheels) {
    options.ignore_floor_links.push_back(wheel.link);
    options.ignore_floor_links.push_back(wheel.carrier);
  }
  return options;
}

std::string first_refusal(const CheckReport& report) {
  for (const Violation& v : report.violations) {
    if (v.violated) return v.constraint + " " + std::to_string(v.worst) + " " + v.unit;
  }
  return "";
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
  const Robot& robot = *plan.robot->robot;
  const double meets_at_s = crossing.x_m / scenario.drive->speed_m_s + crossing.delay_s;
  const std::vector<Obstacle> obstacles = {person(crossing, meets_at_s)};
  WorldDistance seen;
  seen.obstacles = obstacles;
  planner.show(seen);
  const CollisionWorld world(robot, nullptr, obstacles, collision_options(*plan.wheels));
  CheckOptions check;
  check.obstacles = obstacles;

  CrossingResult result;
  for (int executed = 0; executed + 1 < planner.plan_size(); ++executed) {
    const CycleReport cycle = planner.cycle(executed);
    if (executed % options.every == 0) {
      Plan window = plan;
      window.slots.assign(plan.slots.begin() + executed,
                          plan.slots.begin() + executed + cycle.window + 1);
      const CheckReport judged = check_motion(robot, world, motion_of(graph, window), check);
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
