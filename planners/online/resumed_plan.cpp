#include <locograph/check/judge.h>
#include <locograph/check/motion_curve.h>
#include <locograph/check/plan_ends.h>
#include <locograph/planners/offline/motion/motion_graph.h>
#include <locograph/planners/offline/motion/motion_loads.h>
#include <locograph/planners/offline/motion/motion_planner.h>
#include <locograph/planners/offline/stance/unheld_goal.h>
#include <locograph/planners/online/braking.h>
#include <locograph/planners/online/changing_obstacles.h>
#include <locograph/planners/online/resumed_plan.h>
#include <locograph/planners/plan/carried_wrenches.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/plan/slope_limits.h>
#include <locograph/planners/posture/contact_projection.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/rolling_ball.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace locograph {
namespace {

constexpr double kLeastDwell_s = 0.1;
/// Seeds, from that of the options on.
constexpr int kMostTried = 3;

const Contact* contact_named(const Stance& stance, const std::string& name) {
  const auto found = std::ranges::find(stance.contacts, name, &Contact::name);
  return found == stance.contacts.end() ? nullptr : &*found;
}

/// Contacts that are held on from the first stance are where they touched down, also those of balls
/// that have rolled since.
std::vector<Stance> as_touched_down(std::vector<Stance> stances, const Stance& touched_down) {
  std::set<std::string> held;
  for (const Contact& contact : touched_down.contacts) held.insert(contact.name());
  for (Stance& stance : stances) {
    std::erase_if(held, [&](const std::string& name) { return !contact_named(stance, name); });
    for (Contact& contact : stance.contacts) {
      if (held.contains(contact.name())) contact = *contact_named(touched_down, contact.name());
    }
  }
  return stances;
}

/// Wrenches at the contacts of one stance in the order of another one with the same contacts.
StanceWrenches reordered(const StanceWrenches& wrenches, const Stance& of, const Stance& to) {
  StanceWrenches result;
  for (const Contact& contact : to.contacts) {
    const auto at = contact_named(of, contact.name()) - of.contacts.data();
    result.push_back(wrenches.at(static_cast<std::size_t>(at)));
  }
  return result;
}

/// Adds the rest of a motion to its beginning.
class Continuation {
 public:
  Continuation(const Task& task, Motion executed, const std::vector<PlanSegment>& segments)
      : task_(task), loads_(*task.robot->robot) {
    whole_.motion = std::move(executed);
    whole_.status = PlannerStatus::kSolved;
    for (const PlanSegment& segment : segments) {
      SegmentRecord record;
      record.first = segment.first;
      record.last = segment.last;
      record.stance = whole_.motion.stance_from[static_cast<std::size_t>(segment.first)];
      record.duration_s = segment.duration_s;
      record.planner = segment.planner;
      whole_.segments.push_back(std::move(record));
    }
  }

  /// waits_s: that the robot stands at least before it goes on.
  MotionPlan go_on(const MotionPlan& rest, double waits_s = 0.0) && {
    const Motion& then = rest.motion;
    stands_in_ = whole_.motion.stance_from.back();
    touched_down_ = whole_.motion.stances[static_cast<std::size_t>(stands_in_)];
    with_wrenches_ = !whole_.motion.wrenches.empty() && !whole_.motion.wrenches.back().empty() &&
                     !then.wrenches.empty() && !then.wrenches.front().empty();
    if (!with_wrenches_) whole_.motion.wrenches.clear();
    stand(then, waits_s);
    append(rest);
    return std::move(whole_);
  }

 private:
  /// The last configuration, while forces go over to those of the motion that follows.
  void stand(const Motion& then, double waits_s) {
    Motion& motion = whole_.motion;
    const int last = static_cast<int>(motion.configurations.size()) - 1;
    Dwell dwell{.configuration = motion.configurations.back(),
                .stance = stands_in_,
                .begin_s = motion.time_s.back(),
                .least_s = std::max({task_.margin.dwell_s, kLeastDwell_s, waits_s})};
    if (with_wrenches_) {
      dwell.from = motion.wrenches.back();
      dwell.to = reordered(then.wrenches.front(),
                           then.stances[static_cast<std::size_t>(then.stance_from.front())],
                           touched_down_);
      motion.wrenches.pop_back();
    }
    motion.configurations.pop_back();  // the dwell begins with it
    motion.slopes.pop_back();
    motion.stance_from.pop_back();
    motion.time_s.pop_back();
    const double duration_s = loads_.append(dwell, motion);
    begin_s_ = dwell.begin_s + duration_s;
    const int end = static_cast<int>(motion.configurations.size());
    if (!whole_.segments.empty() && whole_.segments.back().last == last) {
      whole_.segments.back().last = end;
      whole_.segments.back().duration_s += duration_s;
      return;
    }
    SegmentRecord record;
    record.stance = stands_in_;
    record.first = last;
    record.last = end;
    record.duration_s = duration_s;
    record.planner = kDwell;
    whole_.segments.push_back(std::move(record));
  }

  void append(const MotionPlan& rest) {
    Motion& motion = whole_.motion;
    const Motion& then = rest.motion;
    const int first = static_cast<int>(motion.configurations.size());
    const int before = static_cast<int>(motion.stances.size());
    std::vector<Stance> stances = as_touched_down(then.stances, touched_down_);
    stances.front() = touched_down_;  // in its order
    motion.stances.insert(motion.stances.end(), stances.begin(), stances.end());
    for (std::size_t i = 0; i < then.configurations.size(); ++i) {
      motion.time_s.push_back(begin_s_ + then.time_s[i]);
      motion.configurations.push_back(then.configurations[i]);
      motion.slopes.push_back(then.slopes[i]);
      const int stance = then.stance_from[i];
      motion.stance_from.push_back(stance == 0 ? stands_in_ : before + stance);
      if (!with_wrenches_) continue;
      motion.wrenches.push_back(
          stance == 0 ? reordered(then.wrenches[i], then.stances.front(), touched_down_)
                      : then.wrenches[i]);
    }
    for (SegmentRecord record : rest.segments) {
      record.first += first;
      record.last += first;
      record.stance = record.stance == 0 ? stands_in_ : before + record.stance;
      whole_.segments.push_back(std::move(record));
    }
  }

  const Task& task_;
  MotionLoads loads_;
  MotionPlan whole_;
  int stands_in_ = 0;    // the stance in which it ended
  Stance touched_down_;  // that stance
  bool with_wrenches_ = false;
  double begin_s_ = 0.0;  // of the rest
};

int last_of(const Graph& graph) { return static_cast<int>(plan_of(graph).slots.size()) - 1; }

/// From where a plan stopped on, as it has it now: contacts that are held have rolled before.
CheckReport judged_from(int stopped_at, int last, const Graph& graph, const Judge& judge,
                        CheckOptions options) {
  options.starts_at_rest = false;  // balls are on their way
  options.ends_at_rest = options.ends_at_rest && last == last_of(graph);
  return judge.check(motion_of(graph, plan_of(graph), stopped_at, last), options);
}

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
    const int stance = planned_.stance_from[static_cast<std::size_t>(from_)];
    then.stances.assign(planned_.stances.begin() + stance, planned_.stances.end());
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
      then.stance_from.push_back(planned_.stance_from[i] - stance);
      if (!planned_.wrenches.empty()) then.wrenches.push_back(planned_.wrenches[i]);
    }
    return then;
  }

  /// The first steps, none longer than planned ones. All are in one stance.
  Motion sampled(const Motion& coarse, int steps) const {
    Motion begins = part_of(MotionCurve(robot_, coarse), 0, steps);
    std::vector<double> times_s = {0.0};
    std::vector<StanceWrenches> wrenches;
    if (!coarse.wrenches.empty()) wrenches.push_back(coarse.wrenches.front());
    for (int step = 1; step <= steps; ++step) {
      const auto i = static_cast<std::size_t>(step);
      const double from_s = coarse.time_s[i - 1], to_s = coarse.time_s[i];
      const double planned_s = planned_.time_s[static_cast<std::size_t>(from_) + i] -
                               planned_.time_s[static_cast<std::size_t>(from_) + i - 1];
      const int parts = std::max(1, static_cast<int>(std::round((to_s - from_s) / planned_s)));
      for (int part = 1; part <= parts; ++part) {
        const double share = static_cast<double>(part) / parts;
        times_s.push_back(part == parts ? to_s : from_s + share * (to_s - from_s));
        if (coarse.wrenches.empty()) continue;
        // The last ones may be those of another stance.
        StanceWrenches between = coarse.wrenches[part == parts ? i : i - 1];
        const StanceWrenches& next = coarse.wrenches[i];
        for (std::size_t c = 0; c < between.size() && part < parts && step < steps; ++c) {
          between[c] += share * (next[c] - between[c]);
        }
        wrenches.push_back(std::move(between));
      }
    }
    if (steps == 0) return with(begins, wrenches);
    begins = resampled(MotionCurve(robot_, begins), times_s);
    begins.stance_from.back() = coarse.stance_from[static_cast<std::size_t>(steps)];
    return with(begins, wrenches);
  }

  static Motion with(Motion motion, const std::vector<StanceWrenches>& wrenches) {
    motion.wrenches = wrenches;
    return motion;
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
    const double x = static_cast<double>(step) / steps;
    const Eigen::VectorXd here = (1.0 - (10.0 - 15.0 * x + 6.0 * x * x) * x * x * x) * off;
    Eigen::VectorXd q = planned.configurations[static_cast<std::size_t>(step)];
    robot.integrate(Eigen::VectorXd(q).data(), here.data(), q.data());
    state.update(way.back().data());
    closed.set(contacts, held_balls(state, contacts, [](const Contact&) { return true; }));
    if (!closed.project(q)) return {};
    way.push_back(std::move(q));
  }
  return way;
}

/// The least time, in steps, after which a motion keeps away from obstacles that change.
std::optional<double> free_after(const Motion& rest, double begin_s, ChangingObstacles& obstacles) {
  constexpr double kStep_s = 0.25, kApart_m = 0.02;
  std::vector<std::vector<Eigen::Vector3d>> centres;
  for (const Eigen::VectorXd& q : rest.configurations) centres.push_back(obstacles.centres(q));
  const auto is_free = [&](double after_s) {
    for (std::size_t i = 0; i < centres.size(); ++i) {
      const double time_s = begin_s + after_s + rest.time_s[i];
      if (!obstacles.keep_away(centres[i], time_s, kApart_m)) return false;
    }
    return true;
  };
  for (double after_s = 0.0; after_s <= kStands_s; after_s += kStep_s) {
    if (is_free(after_s)) return after_s;
  }
  return {};
}

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
    resumed.graph = motion_graph(task, Continuation(task, executed, plan.segments).go_on(found));
    if (plan.world) resumed.graph->replace_parameter(kWorldNumber, plan.world);
    const CheckReport report =
        judged_from(static_cast<int>(plan.slots.size()) - 1, last_of(*resumed.graph),
                    *resumed.graph, judge, task.check);
    if (report.feasible) break;
    resumed.graph.reset();
    resumed.status = PlannerStatus::kNotFound;
    resumed.reason = "refused: " + violation_text(report.worst());
  }
  resumed.total_s = watch.seconds();
  return resumed;
}

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
  std::string why =
      "the way is not free within " + std::to_string(static_cast<int>(kStands_s)) + " s";
  for (int steps = std::min(most, kFewestSteps);; steps = std::min(2 * steps, most)) {
    int slow = 0;
    MotionPlan rest = later.motion(steps, slow);
    Motion moves = rest.motion;
    if (slow > 0) {
      std::vector<Eigen::VectorXd> back = way_back(rest.motion, slow, stands, robot);
      if (back.empty()) return refused("no way leads back to the planned one");
      std::ranges::move(back, moves.configurations.begin());
    }
    const auto after_s = free_after(moves, executed.time_s.back(), obstacles);
    if (!after_s) break;
    const int left = static_cast<int>(moves.configurations.size()) - 1;
    // What moves and bears the robot in the slow steps, and the edges for that.
    const auto assembled = [&] {
      MotionPlan whole = Continuation(task, executed, plan.segments).go_on(rest, *after_s);
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
    const int last = last_of(graph), slow_to = last - left + slow;
    CheckReport report = judged_from(at, std::min(last, slow_to + 2), graph, judge, task.check);
    if (report.feasible) report = judged_from(at, last, graph, judge, task.check);
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
