#include <locograph/planners/offline/motion/motion_loads.h>
#include <locograph/planners/online/continuation.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/robots/rolling_ball.h>

#include <algorithm>
#include <set>
#include <utility>

namespace locograph {
namespace {

constexpr double kLeastDwell_s = 0.1;

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
    // A robot that stopped where contacts change stands in what comes after.
    if (!whole_.segments.empty() && whole_.segments.back().last == last &&
        whole_.segments.back().stance == stands_in_) {
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

MotionPlan continued(const Task& task, Motion executed, const std::vector<PlanSegment>& segments,
                     const MotionPlan& rest, double waits_s) {
  return Continuation(task, std::move(executed), segments).go_on(rest, waits_s);
}

int last_configuration(const Graph& graph) {
  return static_cast<int>(plan_of(graph).slots.size()) - 1;
}

int held_balls_since(const Plan& plan, int configuration) {
  const StanceParameter& here = *plan.stance_from[static_cast<std::size_t>(configuration)];
  int since = configuration;
  for (std::size_t k = 0; k < here.contacts.size(); ++k) {
    if (!is_ball(here.contacts[k]->contact.effector)) continue;
    since = std::min(since, held_since(plan.stance_from, here.contact_numbers[k], configuration));
  }
  return since;
}

CheckReport judged_from(int configuration, int last, const Graph& graph, const Judge& judge,
                        CheckOptions options) {
  options.starts_at_rest = false;  // balls are on their way
  options.ends_at_rest = options.ends_at_rest && last == last_configuration(graph);
  return judge.check(motion_of(graph, plan_of(graph), configuration, last), options);
}

CheckReport judged_on(const Plan& stopped, const Graph& graph, const Judge& judge,
                      const Task& task) {
  const int at = static_cast<int>(stopped.slots.size()) - 1, last = last_configuration(graph);
  const CheckReport report = judged_from(at, last, graph, judge, task.check);
  const int since = held_balls_since(stopped, at);
  if (!report.feasible || since == at) return report;
  World touchable = task.world->world();
  touchable.map = nullptr;
  touchable.obstacles.clear();
  return judged_from(since, last, graph, Judge(task.robot->robot, std::move(touchable)),
                     task.check);
}

}  // namespace locograph
