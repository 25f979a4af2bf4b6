#include <locograph/check/judge.h>
#include <locograph/check/plan_ends.h>
#include <locograph/planners/offline/motion/motion_graph.h>
#include <locograph/planners/offline/motion/motion_planner.h>
#include <locograph/planners/offline/stance/unheld_goal.h>
#include <locograph/planners/online/braking.h>
#include <locograph/planners/online/continuation.h>
#include <locograph/planners/online/resumed_plan.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/rolling_ball.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace locograph {
namespace {

/// Seeds, from that of the options on.
constexpr int kMostTried = 3;

}  // namespace

World world_at_rest(const World& world, double time_s) {
  World now = world;
  std::erase_if(now.obstacles,
                [&](const Obstacle& one) { return !one.is_there(time_s, time_s + kStands_s); });
  for (Obstacle& obstacle : now.obstacles) {
    obstacle.world_from_obstacle = obstacle.pose_at(std::max(time_s, obstacle.appears_s));
    obstacle.motion.clear();
    obstacle.repeat_s = 0.0;
    obstacle.appears_s = -std::numeric_limits<double>::infinity();
    obstacle.vanishes_s = std::numeric_limits<double>::infinity();
  }
  return now;
}

ResumedPlan resume_plan(const Graph& stopped, const Task& task,
                        std::shared_ptr<const WorldSnapshot> world,
                        const StancePlannerOptions& options) {
  const Stopwatch watch;
  const Plan plan = plan_of(stopped);
  Motion executed = motion_of(stopped, plan);
  if (executed.slopes.back().size() == 0) {
    executed.slopes.back() = Eigen::VectorXd::Zero(task.robot->robot->tangent_size());
  }
  Task rest = task;
  rest.world = world;
  rest.start_configuration = executed.configurations.back();
  rest.start = executed.stances[static_cast<std::size_t>(executed.stance_from.back())];
  RobotState state(*task.robot->robot);
  state.update(rest.start_configuration.data());
  for (Contact& contact : rest.start.contacts) contact = rolled_to(state, contact);
  const Judging judging = judging_of(std::make_shared<const Task>(task));
  const Judge judge(task.robot->robot, std::move(world));
  const PlanEnds ends = plan_ends(executed, judging.ends.value());
  const int reached = std::min(ends.goals_reached, static_cast<int>(rest.goals.size()) - 1);
  rest.goals.erase(rest.goals.begin(), rest.goals.begin() + reached);

  ResumedPlan resumed;
  if (const auto unheld = unheld_goal(rest, options.termination.deadline)) {
    resumed.status = PlannerStatus::kNotFound;
    resumed.reason = unheld->text;
    resumed.total_s = watch.seconds();
    return resumed;
  }
  StancePlannerOptions asked = options;
  for (int tried = 0; tried < kMostTried && !resumed.graph; ++tried, ++asked.seed) {
    if (tried > 0 && options.termination.ended()) break;
    const MotionPlan found = plan_motion(rest, asked);
    static_cast<PlannerAnswer&>(resumed) = found;
    if (!found.success()) continue;
    resumed.graph = motion_graph(task, continued(task, executed, plan.segments, found));
    if (plan.world) resumed.graph->replace_parameter(kWorldNumber, plan.world);
    const CheckReport report = judged_on(plan, *resumed.graph, judge, task);
    if (report.feasible) break;
    resumed.graph.reset();
    resumed.status = PlannerStatus::kNotFound;
    resumed.reason = "refused: " + violation_text(report.worst());
  }
  resumed.total_s = watch.seconds();
  return resumed;
}

}  // namespace locograph
