#include "crossing_cases.h"

#include <locograph/check/judge.h>
#include <locograph/check/motion_curve.h>
#include <locograph/planners/offline/drive/drive_graph.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>
#include <locograph/planners/online/free_drive.h>
#include <locograph/planners/plan/judging.h>
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
  const auto task = std::make_shared<const Task>(task_of(scenario));
  Motion planned = plan_wheeled_drive(*task).motion;
  const double planned_s = planned.time_s.back();
  Graph graph = *drive_graph(*task, planned);
  const double meets_at_s = crossing.x_m / scenario.drive->speed_m_s + crossing.delay_s;
  World known = plan_of(graph).world->snapshot->world();
  known.obstacles = {person(crossing, meets_at_s)};
  const auto seen = std::make_shared<const WorldSnapshot>(known);
  Judging judging = judging_of(task);
  World truth = judging.world->world();
  truth.obstacles = known.obstacles;
  judging.world = std::make_shared<const WorldSnapshot>(truth);
  const Judge judge(judging.robot, judging.world);
  const CheckOptions check = window_options(*task);

  CrossingResult result;
  WalkOptions walk = walk_options_for(plan_of(graph));
  walk.rate_hz = options.rate_hz;
  walk.cycle_iterations = options.cycle_iterations;
  walk.verify = step_check(judging);
  walk.resume = [&](const Graph& stopped) -> std::optional<Graph> {
    ResumedPlan waited = wait_for_free_drive(stopped, planned, *task, seen);
    result.not_waited = waited.success() ? "" : waited.reason;
    if (!waited.success()) return {};
    ++result.waits;
    planned = motion_of(*waited.graph, plan_of(*waited.graph));
    return std::move(waited.graph);
  };
  int cycles = 0;
  walk.on_cycle = [&](const CycleReport& cycle) {
    if (cycles++ % options.every != 0) return;
    const CheckReport judged = judge.check(window_of(graph, plan_of(graph), cycle), check);
    ++result.windows;
    result.called_feasible += cycle.success() ? 1 : 0;
    result.judged_feasible += judged.feasible ? 1 : 0;
    result.agreed_feasible += cycle.success() && judged.feasible ? 1 : 0;
    if (!cycle.success() || judged.feasible) return;
    ++result.wrongly_feasible;
    if (result.refused.empty()) result.refused = first_refusal(judged);
  };
  const WalkReport report = walk_plan(
      graph, [&seen](int executed) { return executed == 0 ? seen : nullptr; }, walk);
  const Plan walked = plan_of(graph);
  judging.incomplete = walked.incomplete;
  const bool feasible = judged(graph, walked, judging).feasible;
  result.arrived = report.success() && feasible;
  result.stopped_safely = !report.success() && feasible;
  result.times_planned = motion_of(graph, walked).time_s.back() / planned_s;
  result.reason = report.reason;
  return result;
}

}  // namespace locograph
