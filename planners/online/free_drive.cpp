#include <locograph/planners/offline/drive/drive_graph.h>
#include <locograph/planners/online/changing_obstacles.h>
#include <locograph/planners/online/driven_way.h>
#include <locograph/planners/online/free_drive.h>
#include <locograph/planners/online/heading.h>
#include <locograph/planners/online/led_wrenches.h>
#include <locograph/planners/plan/plan.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace locograph {
namespace {

/// The way on which the base is led back to its plan.
constexpr double kBack_m = 1.5;
/// Of a step while the robot speeds up.
constexpr int kMostParts = 32;

/// Way and times from 0 on, from where the robot stands at rest.
struct Rest {
  Motion motion;
  std::vector<double> gone_m = {0.0};

  void add(const Eigen::VectorXd& q) {
    if (!motion.configurations.empty()) {
      const Eigen::VectorXd& before = motion.configurations.back();
      gone_m.push_back(gone_m.back() + (q - before).head<3>().norm());
    }
    motion.configurations.push_back(q);
  }

  /// Moves what was planned to where the robot stands, less and less.
  void lead_back(const Eigen::VectorXd& stands) {
    std::vector<Eigen::VectorXd>& way = motion.configurations;
    const Eigen::Vector3d off = (stands - way.front()).head<3>();
    const double turned = turn_between(way.front().data(), stands.data());
    const double back_m = std::min(kBack_m, gone_m.back());
    for (std::size_t k = 1; k < way.size(); ++k) {
      const double left = share_left(gone_m[k] / back_m);
      way[k].head<3>() += left * off;
      turn_base(left * turned, way[k].data());
    }
    way.front() = stands;
  }
};

Eigen::VectorXd between(const Robot& robot, const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                        double share) {
  if (share == 1.0) return b;
  Eigen::VectorXd step(robot.tangent_size()), q = a;
  robot.difference(a.data(), b.data(), step.data());
  step *= share;
  robot.integrate(a.data(), step.data(), q.data());
  return q;
}

/// Along the rest of what was planned, in its time but for the beginning, as the root of the way at
/// first. Steps that take longer there than others do are made in as many that do not: what moves
/// is looked at in each, and wheels that steer while one speeds up slip less.
std::optional<Rest> along_the_plan(const Robot& robot, const Motion& planned, int at,
                                   const Eigen::VectorXd& stands, DrivenWheels& wheels,
                                   double speed_m_s, double usual_s) {
  constexpr double kRounding = 1e-3;
  const auto share_at = [&](double gone_m) { return share_of_speed(gone_m, speed_m_s); };
  const auto slowed = [](double share, double after) { return 2.0 / (share + after); };
  Rest rest;
  rest.motion.time_s = {0.0};
  rest.add(planned.configurations[static_cast<std::size_t>(at)]);
  double before = 0.0;
  for (auto i = static_cast<std::size_t>(at) + 1; i < planned.configurations.size(); ++i) {
    const Eigen::VectorXd &from = planned.configurations[i - 1], &to = planned.configurations[i];
    const double step_s = planned.time_s[i] - planned.time_s[i - 1];
    const double way_m = (to - from).head<3>().norm(), gone_m = rest.gone_m.back();
    const bool moves = gone_m + way_m > 0.0;
    int parts = 1;  // the first one is the slowest
    while (moves && before < 1.0 && way_m > 0.0 && parts < kMostParts &&
           slowed(before, share_at(gone_m + way_m / parts)) * step_s / parts >
               (1.0 + kRounding) * usual_s) {
      ++parts;
    }
    for (int part = 1; part <= parts; ++part) {
      rest.add(between(robot, from, to, static_cast<double>(part) / parts));
      const double after = share_at(rest.gone_m.back());
      rest.motion.time_s.push_back(rest.motion.time_s.back() +
                                   (moves ? slowed(before, after) : 1.0) * step_s / parts);
      if (moves) before = after;
    }
  }
  rest.lead_back(stands);
  if (!wheels.drive(rest.motion.configurations)) return {};
  return rest;
}

}  // namespace

ResumedPlan wait_for_free_drive(const Graph& stopped, const Motion& planned, const Task& task,
                                std::shared_ptr<const WorldSnapshot> world) {
  const Stopwatch watch;
  ResumedPlan waited;
  waited.status = PlannerStatus::kNotFound;
  const auto refused = [&](std::string why) {
    waited.reason = std::move(why);
    waited.total_s = watch.seconds();
    return std::move(waited);
  };
  const Plan plan = plan_of(stopped);
  const int at = static_cast<int>(plan.slots.size()) - 1;
  ChangingObstacles obstacles(*task.robot, world->world());
  if (!obstacles.any()) return refused("nothing is known to move or to vanish");
  Motion whole = motion_of(stopped, plan);
  const Robot& robot = *task.robot->robot;
  const int stance = whole.stance_from.back();
  const Eigen::VectorXd stands = whole.configurations.back();
  DrivenWheels wheels(robot, whole.stances[static_cast<std::size_t>(stance)]);
  const int last = static_cast<int>(planned.configurations.size()) - 1;
  if (at >= last) return refused("nothing is left of the plan");
  double left_m = 0.0;
  for (int i = at; i < last; ++i) {
    const auto k = static_cast<std::size_t>(i);
    left_m += (planned.configurations[k + 1] - planned.configurations[k]).head<3>().norm();
  }
  constexpr double kSlant = 0.3;  // beside the plan over the way that is left
  const double off_m =
      (planned.configurations[static_cast<std::size_t>(at)] - stands).head<3>().norm();
  if (off_m > kSlant * std::min(kBack_m, left_m)) {
    return refused("the robot is too far beside the way that was planned");
  }
  const double usual_s = usual_step_s(planned);
  const std::optional<Rest> driven =
      along_the_plan(robot, planned, at, stands, wheels, task.drive->speed_m_s, usual_s);
  if (!driven) return refused("wheels do not stay on the ground on the way back to the plan");
  const Rest& rest = *driven;
  Eigen::VectorXd steered;
  if (!wheels.steer_along(rest.motion.configurations, steered)) steered = stands;
  const double steers_s = steering_s(task, stands, steered);
  const double begin_s = whole.time_s.back();
  const auto after_s = obstacles.free_after(rest.motion, begin_s + steers_s);
  if (!after_s) return refused(obstacles.refusal());
  whole.slopes.resize(whole.configurations.size());
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(robot.tangent_size());
  const auto add = [&](const Eigen::VectorXd& q, double time_s, const Eigen::VectorXd& slope) {
    whole.configurations.push_back(q);
    whole.time_s.push_back(time_s);
    whole.slopes.push_back(slope);
    whole.stance_from.push_back(stance);
  };
  whole.slopes.back() = still;
  const double moves_s = begin_s + steers_s + *after_s;
  const std::vector<Eigen::VectorXd>& way = rest.motion.configurations;
  if (steers_s > 0.0) add(steered, begin_s + steers_s, still);
  constexpr double kLeastWait_s = 0.5;  // of one step
  const double step_s = std::max(2.0 * usual_s, kLeastWait_s);
  const int waits = static_cast<int>(std::ceil(*after_s / step_s));
  for (int k = 1; k <= waits; ++k) {
    add(whole.configurations.back(), begin_s + steers_s + *after_s * k / waits, still);
  }
  for (std::size_t k = 1; k < way.size(); ++k) {
    const bool ends = k + 1 == way.size();
    add(way[k], moves_s + rest.motion.time_s[k], ends ? still : Eigen::VectorXd());
  }
  waited.graph = drive_graph(task, whole);
  if (plan.world) waited.graph->replace_parameter(kWorldNumber, plan.world);
  waited.waits_s = *after_s;
  waited.status = PlannerStatus::kSolved;
  waited.reason = "the way is free";
  waited.total_s = watch.seconds();
  return waited;
}

}  // namespace locograph
