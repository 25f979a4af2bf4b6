#include <locograph/check/judge.h>
#include <locograph/check/plan_ends.h>
#include <locograph/planners/offline/motion/motion_graph.h>
#include <locograph/planners/offline/motion/motion_loads.h>
#include <locograph/planners/offline/motion/motion_planner.h>
#include <locograph/planners/offline/stance/unheld_goal.h>
#include <locograph/planners/online/braking.h>
#include <locograph/planners/online/resumed_plan.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/rolling_ball.h>

#include <algorithm>
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

  MotionPlan go_on(const MotionPlan& rest) && {
    const Motion& then = rest.motion;
    stands_in_ = whole_.motion.stance_from.back();
    touched_down_ = whole_.motion.stances[static_cast<std::size_t>(stands_in_)];
    with_wrenches_ = !whole_.motion.wrenches.empty() && !whole_.motion.wrenches.back().empty() &&
                     !then.wrenches.empty() && !then.wrenches.front().empty();
    if (!with_wrenches_) whole_.motion.wrenches.clear();
    stand(then);
    append(rest);
    return std::move(whole_);
  }

 private:
  /// The last configuration, while forces go over to those of the motion that follows.
  void stand(const Motion& then) {
    Motion& motion = whole_.motion;
    const int last = static_cast<int>(motion.configurations.size()) - 1;
    Dwell dwell{.configuration = motion.configurations.back(),
                .stance = stands_in_,
                .begin_s = motion.time_s.back(),
                .least_s = std::max(task_.margin.dwell_s, kLeastDwell_s)};
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

  CheckOptions going_on = task.check;
  going_on.starts_at_rest = false;  // balls are on their way
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
    // From where it stands on, as the plan has it now: contacts that are held have rolled before.
    const Plan whole = plan_of(*resumed.graph);
    const CheckReport report =
        judge.check(motion_of(*resumed.graph, whole, static_cast<int>(plan.slots.size()) - 1,
                              static_cast<int>(whole.slots.size()) - 1),
                    going_on);
    if (report.feasible) break;
    resumed.graph.reset();
    resumed.status = PlannerStatus::kNotFound;
    resumed.reason = "refused: " + violation_text(report.worst());
  }
  resumed.total_s = watch.seconds();
  return resumed;
}

}  // namespace locograph
