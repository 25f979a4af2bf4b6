#include "crossing_cases.h"

#include <locograph/check/judge.h>
#include <locograph/check/motion_curve.h>
#include <locograph/planners/offline/drive/drive_graph.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>
#include <locograph/planners/plan/slope_limits.h>

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
CheckOptions window_options(const Task& task) {
  CheckOptions options = task.check;
  options.starts_at_rest = options.ends_at_rest = false;
  return options;
}

/// From the executed configuration to the last one of the window, with the slopes that `refine`
/// would give them. It passes the last one as it moved before: what comes after it will change.
Motion window_of(const Graph& graph, const Plan& plan, const CycleReport& cycle) {
  const Robot& robot = *plan.robot->robot;
  const int last = cycle.executed + cycle.window;
  Motion whole = motion_of(graph, plan);
  const int planned = static_cast<int>(whole.configurations.size());
  const auto next = static_cast<std::size_t>(last) + 1;
  if (next < whole.configurations.size()) {
    const Eigen::VectorXd &before = whole.configurations[next - 2],
                          &at = whole.configurations[next - 1];
    Eigen::VectorXd moved(robot.tangent_size());
    robot.difference(before.data(), at.data(), moved.data());
    robot.integrate(at.data(), moved.data(), whole.configurations[next].data());
    whole.time_s[next] = 2.0 * whole.time_s[next - 1] - whole.time_s[next - 2];
    whole.slopes[next - 1] = {};
  }
  for (int i = std::max(1, cycle.executed); i <= last && i + 1 < planned; ++i) {
    Eigen::VectorXd& slope = whole.slopes[static_cast<std::size_t>(i)];
    if (slope.size() == 0) slope = careful_slope(robot, whole, i);
  }
  return part_of(MotionCurve(robot, whole), cycle.executed, last);
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
  const Task task = task_of(scenario);
  Graph graph = *drive_graph(task, plan_wheeled_drive(task).motion);
  LocalPlanner planner(graph, options.planner);
  const Plan& plan = planner.plan();
  const double meets_at_s = crossing.x_m / scenario.drive->speed_m_s + crossing.delay_s;
  const std::vector<Obstacle> obstacles = {person(crossing, meets_at_s)};
  World seen;
  seen.obstacles = obstacles;
  planner.show(std::make_shared<const WorldSnapshot>(seen));
  World world = task.world->world();
  world.obstacles = obstacles;
  const Judge judge(plan.robot->robot, world);
  const CheckOptions check = window_options(task);

  CrossingResult result;
  for (int executed = 0; executed + 1 < planner.plan_size(); ++executed) {
    const CycleReport cycle =
        planner.cycle(executed, {.deadline = Deadline::of_limit(options.cycle_deadline_s)});
    if (executed % options.every == 0) {
      const CheckReport judged = judge.check(window_of(graph, plan, cycle), check);
      ++result.windows;
      result.called_feasible += cycle.success() ? 1 : 0;
      result.judged_feasible += judged.feasible ? 1 : 0;
      result.agreed_feasible += cycle.success() && judged.feasible ? 1 : 0;
      if (cycle.success() && !judged.feasible) {
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
