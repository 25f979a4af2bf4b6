#include "crossing_cases.h"

#include <locograph/check/judge.h>
#include <locograph/planners/offline/drive/drive_graph.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>
#include <locograph/planners/online/free_drive.h>
#include <locograph/planners/plan/judging.h>

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
  JudgedWindows windows(graph, judge, task->check, options.every);

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
  walk.on_cycle = [&](const CycleReport& cycle) { windows.look(cycle); };
  const WalkReport report = walk_plan(
      graph, [&seen](int executed) { return executed == 0 ? seen : nullptr; }, walk);
  static_cast<WindowCounts&>(result) = windows.counts();
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
