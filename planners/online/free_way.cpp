#include <locograph/check/judge.h>
#include <locograph/check/motion_curve.h>
#include <locograph/planners/offline/motion/motion_graph.h>
#include <locograph/planners/online/braking.h>
#include <locograph/planners/online/changing_obstacles.h>
#include <locograph/planners/online/continuation.h>
#include <locograph/planners/online/free_way.h>
#include <locograph/planners/online/led_wrenches.h>
#include <locograph/planners/plan/carried_wrenches.h>
#include <locograph/planners/plan/slope_limits.h>
#include <locograph/planners/posture/contact_projection.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace locograph {
namespace {

/// The rest of a plan that is begun again at rest, its times from 0 on.
class LaterRest {
 public:
  LaterRest(const Robot& robot, const Motion& planned, const std::vector<PlanSegment>& segments,
            int from)
      : robot_(robot), planned_(planned), segments_(segments), from_(from) {}

  /// Steps up to the next rest.
  int most_steps() const {
    const int last = static_cast<int>(planned_.configurations.size()) - 1;
    int to = from_;
    while (to < last && !rests(to)) ++to;
    return to - from_;
  }

  /// Over the first steps its speed grows with the share x of the way that is left of them as
  /// (1 - x^2)^(2/3), the way in the first of them with the third power of time. They are sampled
  /// as the plan is then, in `slow` steps.
  MotionPlan motion(int steps, int& slow) const {
    const Motion coarse = slowed(steps);
    MotionPlan rest;
    Motion& then = rest.motion;
    then = sampled(coarse, steps);
    slow = static_cast<int>(then.configurations.size()) - 1;
    const auto past = [&](auto& to, const auto& from) {
      if (from.empty()) return;
      to.insert(to.end(), from.begin() + steps + 1, from.end());
    };
    past(then.time_s, coarse.time_s);
    past(then.configurations, coarse.configurations);
    past(then.slopes, coarse.slopes);
    past(then.stance_from, coarse.stance_from);
    past(then.wrenches, coarse.wrenches);
    const auto index = [&](int planned) {
      return planned <= from_ ? 0 : planned - from_ - steps + slow;
    };
    for (const PlanSegment& planned : segments_) {
      if (planned.last <= from_) continue;
      SegmentRecord record;
      record.first = index(planned.first);
      record.last = index(planned.last);
      record.stance = then.stance_from[static_cast<std::size_t>(record.first)];
      record.duration_s = then.time_s[static_cast<std::size_t>(record.last)] -
                          then.time_s[static_cast<std::size_t>(record.first)];
      record.planner = planned.planner;
      rest.segments.push_back(std::move(record));
    }
    return rest;
  }

 private:
  bool rests(int i) const {
    const Eigen::VectorXd& slope = planned_.slopes[static_cast<std::size_t>(i)];
    return slope.size() > 0 && slope.isZero(0.0);
  }

  Motion slowed(int steps) const {
    Motion then;
    // In the order in which it comes to them.
    std::vector<int> numbers(planned_.stances.size(), -1);
    const auto number_of = [&](int stance) {
      int& number = numbers.at(static_cast<std::size_t>(stance));
      if (number < 0) {
        number = static_cast<int>(then.stances.size());
        then.stances.push_back(planned_.stances[static_cast<std::size_t>(stance)]);
      }
      return number;
    };
    double before = 0.0;
    for (std::size_t i = static_cast<std::size_t>(from_); i < planned_.configurations.size(); ++i) {
      const int step = static_cast<int>(i) - from_;
      const double left = steps > 0 ? std::max(0.0, 1.0 - static_cast<double>(step) / steps) : 0.0;
      const double share = std::pow(1.0 - left * left, 2.0 / 3.0);
      if (step == 0) {
        then.time_s.push_back(0.0);
        then.slopes.push_back(Eigen::VectorXd::Zero(robot_.tangent_size()));
      } else {
        const double slower = step == 1 && steps > 0 ? 3.0 / share : 2.0 / (before + share);
        then.time_s.push_back(then.time_s.back() +
                              slower * (planned_.time_s[i] - planned_.time_s[i - 1]));
        then.slopes.push_back(share * planned_.slopes[i]);
      }
      before = share;
      then.configurations.push_back(planned_.configurations[i]);
      then.stance_from.push_back(number_of(planned_.stance_from[i]));
      if (!planned_.wrenches.empty()) then.wrenches.push_back(planned_.wrenches[i]);
    }
    return then;
  }

  /// The first steps, none longer than planned ones. All are in one stance.
  Motion sampled(const Motion& coarse, int steps) const {
    const MotionCurve curve(robot_, coarse);
    Motion begins;
    begins.stances = coarse.stances;
    const auto add_vertex = [&](std::size_t i) {
      begins.time_s.push_back(coarse.time_s[i]);
      begins.configurations.push_back(coarse.configurations[i]);
      begins.slopes.push_back(curve.slope(static_cast<int>(i)));
      begins.stance_from.push_back(coarse.stance_from[i]);
      if (!coarse.wrenches.empty()) begins.wrenches.push_back(coarse.wrenches[i]);
    };
    add_vertex(0);
    for (int to = 1; to <= steps; ++to) {
      const auto i = static_cast<std::size_t>(to);
      const double from_s = coarse.time_s[i - 1], duration_s = coarse.time_s[i] - from_s;
      const double planned_s = planned_.time_s[static_cast<std::size_t>(from_) + i] -
                               planned_.time_s[static_cast<std::size_t>(from_) + i - 1];
      constexpr double kMostParts = 1000.0;
      const double slower = planned_s > 0.0 ? std::round(duration_s / planned_s) : 1.0;
      const int parts = static_cast<int>(std::clamp(slower, 1.0, kMostParts));
      const CurveStep step = curve.step(to - 1);
      for (int part = 1; part < parts; ++part) {
        const double share = static_cast<double>(part) / parts;
        begins.time_s.push_back(from_s + share * duration_s);
        step.configuration(share, begins.configurations.emplace_back());
        begins.slopes.push_back(step.slope(share));
        begins.stance_from.push_back(coarse.stance_from[i - 1]);
        if (coarse.wrenches.empty()) continue;
        StanceWrenches& between = begins.wrenches.emplace_back(coarse.wrenches[i - 1]);
        // The last ones may be those of another stance.
        const StanceWrenches& next = coarse.wrenches[i];
        for (std::size_t c = 0; c < between.size() && to < steps; ++c) {
          between[c] += share * (next[c] - between[c]);
        }
      }
      add_vertex(i);
    }
    return begins;
  }

  const Robot& robot_;
  const Motion& planned_;
  const std::vector<PlanSegment>& segments_;
  int from_;
};

/// The way back to a motion from a configuration beside its first one, over some steps in one
/// stance, each on its contacts; what it is off fades as 1 - (10 - 15 x + 6 x^2) x^3. Empty: they
/// do not close.
std::vector<Eigen::VectorXd> way_back(const Motion& planned, int steps,
                                      const Eigen::VectorXd& configuration, const Robot& robot) {
  const std::vector<Contact>& contacts =
      planned.stances[static_cast<std::size_t>(planned.stance_from.front())].contacts;
  ContactProjection closed(robot);
  RobotState state(robot);
  Eigen::VectorXd off(robot.tangent_size());
  robot.difference(planned.configurations.front().data(), configuration.data(), off.data());
  std::vector<Eigen::VectorXd> way = {configuration};
  for (int step = 1; step < steps; ++step) {
    const Eigen::VectorXd here = share_left(static_cast<double>(step) / steps) * off;
    Eigen::VectorXd q = planned.configurations[static_cast<std::size_t>(step)];
    robot.integrate(Eigen::VectorXd(q).data(), here.data(), q.data());
    state.update(way.back().data());
    closed.set(contacts, held_balls(state, contacts, [](const Contact&) { return true; }));
    if (!closed.project(q)) return {};
    way.push_back(std::move(q));
  }
  return way;
}

}  // namespace

ResumedPlan wait_for_free_way(const Graph& stopped, const Motion& planned,
                              const std::vector<PlanSegment>& segments, const Task& task,
                              std::shared_ptr<const WorldSnapshot> world) {
  const Stopwatch watch;
  constexpr int kFewestSteps = 8, kMostSteps = 128;
  constexpr double kOff = 1e-9;
  ResumedPlan waited;
  waited.status = PlannerStatus::kNotFound;
  const auto refused = [&](std::string why) {
    waited.graph.reset();
    waited.reason = std::move(why);
    waited.total_s = watch.seconds();
    return std::move(waited);
  };
  const Plan plan = plan_of(stopped);
  const int at = static_cast<int>(plan.slots.size()) - 1;
  ChangingObstacles obstacles(*task.robot, world->world());
  if (!obstacles.any()) return refused("nothing is known to move or to vanish");
  if (planned.slopes.empty() || at + 1 >= static_cast<int>(planned.configurations.size())) {
    return refused("nothing is left of the plan");
  }
  Motion executed = motion_of(stopped, plan);
  const Eigen::VectorXd stands = executed.configurations.back();
  const bool off = !(planned.configurations[static_cast<std::size_t>(at)] - stands).isZero(kOff);
  executed.slopes.back() = Eigen::VectorXd::Zero(task.robot->robot->tangent_size());
  const Robot& robot = *task.robot->robot;
  const LaterRest later(robot, planned, segments, at);
  const int most = later.most_steps();
  if (off && most < kFewestSteps) return refused("the robot is beside the way that was planned");
  const Judge judge(task.robot->robot, world);
  std::string why;
  for (int steps = std::min(most, kFewestSteps);; steps = std::min(2 * steps, most)) {
    int slow = 0;
    MotionPlan rest = later.motion(steps, slow);
    Motion moves = rest.motion;
    if (slow > 0) {
      std::vector<Eigen::VectorXd> back = way_back(rest.motion, slow, stands, robot);
      if (back.empty()) return refused("no way leads back to the planned one");
      std::ranges::move(back, moves.configurations.begin());
    }
    const auto after_s = obstacles.free_after(moves, executed.time_s.back());
    if (!after_s) {
      if (why.empty()) why = obstacles.refusal();
      break;
    }
    const int left = static_cast<int>(moves.configurations.size()) - 1;
    // What moves and bears the robot in the slow steps, and the edges for that.
    const auto assembled = [&] {
      MotionPlan whole = continued(task, executed, plan.segments, rest, *after_s);
      Motion& all = whole.motion;
      Graph graph = motion_graph(task, whole);
      const Plan now = plan_of(graph);
      const int begin = static_cast<int>(now.slots.size()) - 1 - left;
      const Motion before = motion_of_slopes(graph, now);
      for (int i = 0; i < slow; ++i) {
        const int slot = now.slots[static_cast<std::size_t>(begin + i)];
        graph.vertex(VertexId<VertexConfiguration>{slot}).state =
            moves.configurations[static_cast<std::size_t>(i)];
      }
      carry_slopes(before, now, graph, {begin, begin + slow});
      balance_wrenches(now, graph, {begin, begin + slow});
      Motion borne = motion_of(graph, now);
      all.configurations = std::move(borne.configurations);
      all.slopes = std::move(borne.slopes);
      all.wrenches = std::move(borne.wrenches);
      return whole;
    };
    MotionPlan whole = assembled();
    if (!rest.motion.wrenches.empty()) {
      // Forces go over while it stands, to those with which it goes on.
      rest.motion.wrenches.front() = *(whole.motion.wrenches.end() - 1 - left);
      whole = assembled();
    }
    Graph graph = motion_graph(task, whole);
    if (plan.world) graph.replace_parameter(kWorldNumber, plan.world);
    const int last = last_configuration(graph), slow_to = last - left + slow;
    CheckReport report = judged_from(at, std::min(last, slow_to + 2), graph, judge, task.check);
    if (report.feasible) report = judged_on(plan, graph, judge, task);
    if (report.feasible) {
      waited.graph = std::move(graph);
      waited.waits_s = *after_s;
      waited.status = PlannerStatus::kSolved;
      waited.reason = "the way is free";
      waited.total_s = watch.seconds();
      return waited;
    }
    why = "refused: " + violation_text(report.worst());
    if (steps >= most || steps >= kMostSteps) break;
  }
  return refused(std::move(why));
}

}  // namespace locograph
