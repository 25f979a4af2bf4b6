#include <locograph/check/plan_ends.h>
#include <locograph/check/violation_tally.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace locograph {
namespace {

std::string off_by(const std::string& what, double off_m, double off_rad) {
  char text[64];
  std::snprintf(text, sizeof text, " is %.3g m and %.3g rad away", off_m, off_rad);
  return what + text;
}

/// What of the directions that a contact's kind holds is off [rad].
double turned_rad(const Contact& contact, const Contact& asked) {
  const ContactKind kind = asked.effector.kind;
  const double tilted =
      kind == ContactKind::kGrasp ? 0.0 : angle_between(contact.normal, asked.normal);
  const bool in_yaw = kind == ContactKind::kSurface || kind == ContactKind::kGrasp;
  if (!in_yaw || !asked.forward) return tilted;
  if (!contact.forward) return std::numbers::pi;  // it may be anything
  return std::max(tilted, angle_between(contact.normal.cross(*contact.forward),
                                        asked.normal.cross(*asked.forward)));
}

/// Only a wheel that is locked is where its contact is; in plans of stances all are.
std::string off_stance(const Stance& stance, const Stance& asked, bool all_locked) {
  for (const Contact& place : asked.contacts) {
    const auto found = std::ranges::find(stance.contacts, place.name(), &Contact::name);
    if (found == stance.contacts.end()) return place.name() + " does not touch";
    if (found->effector.kind == ContactKind::kWheel && !found->locked && !all_locked) {
      return place.name() + " is not locked and may be elsewhere";
    }
    const double off_m = (found->position - place.position).norm();
    const double off_rad = turned_rad(*found, place);
    if (off_m <= limits::kClosed_m && off_rad <= limits::kClosed_rad) continue;
    return off_by(place.name(), off_m, off_rad);
  }
  if (stance.contacts.size() == asked.contacts.size()) return "";
  return "something else touches";
}

bool has_base(const Eigen::VectorXd& q) { return q.size() >= 7 && q.allFinite(); }

double heading_of(const Eigen::VectorXd& q) {
  return std::atan2(2.0 * (q[6] * q[5] + q[3] * q[4]),
                    q[6] * q[6] + q[3] * q[3] - q[4] * q[4] - q[5] * q[5]);
}

/// Heading at a vertex, full turns counted: a step turns by the shorter way, as it is judged.
double heading_at(const Motion& motion, std::size_t vertex) {
  double heading = heading_of(motion.configurations[0]);
  for (std::size_t i = 1; i <= vertex; ++i) {
    heading +=
        std::remainder(heading_of(motion.configurations[i]) - heading, 2.0 * std::numbers::pi);
  }
  return heading;
}

std::string off_base(const Motion& motion, std::size_t vertex, const TaskPlace& asked) {
  const auto end = motion.configurations.begin() + static_cast<std::ptrdiff_t>(vertex) + 1;
  if (!std::all_of(motion.configurations.begin(), end, has_base)) return "there is no base";
  const Eigen::VectorXd& configuration = motion.configurations[vertex];
  const double off_m = (configuration.head<2>() - asked.base.head<2>()).norm();
  const double off_rad = std::abs(heading_at(motion, vertex) - asked.base.z());
  if (off_m <= asked.within_m && off_rad <= asked.within_rad) return "";
  return off_by("the base", off_m, off_rad);
}

/// What is elsewhere than asked; empty: nothing.
std::string off_place(const Motion& motion, std::size_t vertex, const TaskPlace& asked) {
  if (asked.stance.contacts.empty()) return off_base(motion, vertex, asked);
  const int stance = motion.stance_from.empty() ? -1 : motion.stance_from[vertex];
  if (stance < 0) return "the stance is not known";
  return off_stance(motion.stances.at(static_cast<std::size_t>(stance)), asked.stance,
                    motion.stances_only);
}

}  // namespace

PlanEnds plan_ends(const Motion& motion, const PlannedTask& task) {
  PlanEnds ends;
  ends.goals = static_cast<int>(task.goals.size());
  ends.off_start = off_place(motion, 0, task.start);
  const std::size_t vertices = motion.configurations.size(), goals = task.goals.size();
  std::size_t reached = 0;
  for (std::size_t i = 0; i < vertices; ++i) {
    const bool last = i + 1 == vertices;
    while (reached < goals && (reached + 1 < goals || last)) {
      ends.off_goal = off_place(motion, i, task.goals[reached]);
      if (!ends.off_goal.empty()) break;
      ++reached;
    }
  }
  ends.goals_reached = static_cast<int>(reached);
  return ends;
}

std::vector<Violation> end_violations(const Motion& motion, const PlanEnds& ends,
                                      const std::string& no_start, const std::string& no_goals) {
  const std::size_t vertices = motion.configurations.size();
  ViolationTally start("scenario_start", "count", 0.0, Worse::kHigher, vertices);
  ViolationTally goals("scenario_goals", "count", 0.0, Worse::kHigher, vertices);
  const Eigen::Vector3d nowhere = Eigen::Vector3d::Zero();
  if (no_start.empty()) {
    start.add(ends.starts() ? 0.0 : 1.0, 0, motion.time_s.front(), nowhere,
              [&] { return ends.starts() ? "it begins there" : ends.off_start; });
  }
  if (no_goals.empty()) {
    goals.add(ends.goals - ends.goals_reached, static_cast<int>(vertices) - 1, motion.time_s.back(),
              nowhere, [&] {
                return ends.goals_reached == ends.goals
                           ? "all are reached"
                           : "goal " + std::to_string(ends.goals_reached + 1) + " of " +
                                 std::to_string(ends.goals) + ": " + ends.off_goal;
              });
  }
  return {start.result(no_start), goals.result(no_goals)};
}

}  // namespace locograph
