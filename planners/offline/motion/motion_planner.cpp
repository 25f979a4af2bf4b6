#include <locograph/check/judge.h>
#include <locograph/planners/offline/motion/motion_planner.h>
#include <locograph/planners/offline/motion/segment_motion.h>
#include <locograph/planners/offline/stance/stance_planners.h>
#include <locograph/planners/offline/stance/stance_space.h>
#include <locograph/planners/offline/stance/standing_wheels.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace locograph {
namespace {

/// A motion that inertia brings out of balance is slowed down by so much, so often.
constexpr double kSlower = 1.3;
constexpr int kMostSlower = 6;
/// So many refused segments make one more of their planners tried.
constexpr std::size_t kRefusedForMore = 5;
/// Of random trees, for the same reason.
constexpr int kFewStates = 4000;

/// What one segment came to be, to be looked up when the stance planner comes back to it.
struct Solved {
  Stance before, held, after;
  Eigen::VectorXd from, to;
  std::size_t planner = 0;  ///< the first one that has not been refused
  SegmentPace pace;
  int slowed = 0;
  bool judged = false;  ///< and found feasible, by itself
  SegmentMotion motion;
};

bool is_of_inertia(const Violation& violation) {
  return violation.constraint == "static_balance" || violation.constraint == "torque_limits";
}

bool same(const Stance& a, const Stance& b) {
  return std::equal(a.contacts.begin(), a.contacts.end(), b.contacts.begin(), b.contacts.end(),
                    [](const Contact& x, const Contact& y) {
                      return x.name() == y.name() && x.position == y.position &&
                             x.normal == y.normal && x.forward == y.forward;
                    });
}

/// Contacts of `of` whose end effectors are not in `held`.
std::vector<Contact> besides(const Stance& of, const Stance& held) {
  std::vector<Contact> contacts;
  for (const Contact& contact : of.contacts) {
    if (std::ranges::find(held.contacts, contact.name(), &Contact::name) == held.contacts.end()) {
      contacts.push_back(contact);
    }
  }
  return contacts;
}

class MotionSearch {
 public:
  MotionSearch(const StanceProblem& problem, const StancePlannerOptions& stances,
               const MotionOptions& options, MotionPlan& plan)
      : problem_(problem),
        stances_(stances),
        plan_(plan),
        space_(problem, stances_),
        mover_(problem, options),
        all_planners_(!options.segment_planners.empty()),
        judge_(problem.robot->robot, problem.world) {}

  /// See StancePlannerOptions::accept.
  std::size_t accept(const std::vector<Stance>& stances,
                     std::vector<Eigen::VectorXd>& configurations, std::size_t first) {
    const std::size_t count = configurations.size() - 1;
    ways_.resize(count, nullptr);
    for (std::size_t j = first; j < count; ++j) {
      if (!found_at(stances, configurations, j) &&
          !move_postures(stances, configurations, first, j)) {
        return refuse(j);
      }
    }
    for (bool whole = false;; whole = true) {
      assemble(stances, configurations);
      std::vector<StanceWrenches> wrenches(plan_.motion.configurations.size());
      plan_.report = judged(plan_.motion, &wrenches);
      plan_.motion.wrenches = std::move(wrenches);
      if (plan_.report.feasible) return 0;
      // At first those only that the report names: of each constraint one.
      std::vector<bool> named(count, whole);
      for (const Violation* violation : plan_.report.violated()) {
        named[segment_of(*violation)] = true;
      }
      bool mended = false;
      for (std::size_t j = first; j < count; ++j) {
        if (ways_[j]->judged || !named[j]) continue;
        if (!mend(stances, j, mended)) return refuse(j);
      }
      if (mended || slow_down(first)) continue;
      if (!whole) continue;
      const std::vector<const Violation*> violated = plan_.report.violated();
      const std::size_t j = violated.empty() ? first : segment_of(*violated.front());
      ways_[j]->motion.reason = "refused: " + violation_text(plan_.report.worst());
      return refuse(std::max(first, j));
    }
  }

  /// Without success: as far as segments were found.
  void assemble(const std::vector<Stance>& stances,
                const std::vector<Eigen::VectorXd>& configurations) {
    Motion& motion = plan_.motion;
    motion = {};
    motion.stances = stances;
    plan_.segments.clear();
    double time_s = 0.0;
    for (std::size_t j = 0; j < ways_.size() && ways_[j]->motion.found; ++j) {
      const SegmentMotion& way = ways_[j]->motion;
      SegmentRecord record;
      record.stance = static_cast<int>(j);
      record.first = static_cast<int>(motion.configurations.size());
      const std::size_t steps = way.configurations.size() - 1;
      for (std::size_t i = 0; i < steps; ++i) {
        motion.configurations.push_back(way.configurations[i]);
        motion.slopes.push_back(way.slopes[i]);
        motion.time_s.push_back(time_s + way.duration_s * static_cast<double>(i) /
                                             static_cast<double>(steps));
        motion.stance_from.push_back(record.stance);
      }
      time_s += way.duration_s;
      record.last = static_cast<int>(motion.configurations.size());
      record.duration_s = way.duration_s;
      record.planner = way.planner;
      record.seconds = way.path_s;
      record.timing_s = way.timing_s;
      record.length = way.length;
      record.straight = way.straight;
      record.clear_m = way.clear_m;
      plan_.segments.push_back(std::move(record));
    }
    const std::size_t done = plan_.segments.size();
    motion.stances.resize(done + 1);
    motion.configurations.push_back(configurations[done]);
    motion.slopes.push_back(Eigen::VectorXd::Zero(problem_.robot->robot->tangent_size()));
    motion.time_s.push_back(time_s);
    motion.stance_from.push_back(static_cast<int>(done));
  }

  /// Why the last one was refused; empty: none was.
  const std::string& refused_reason() const { return refused_reason_; }

  void keep(std::size_t segments) { ways_.resize(std::min(segments, ways_.size())); }

 private:
  std::size_t refuse(std::size_t segment) {
    ++plan_.refused_segments;
    refused_reason_ = ways_[segment]->motion.reason;
    return segment + 1;
  }

  /// Other postures at an end of segment j, near the one at its other end: where free arms are on
  /// different sides of a bar there is no short way. False: none makes it found; nothing is
  /// changed.
  bool move_postures(const std::vector<Stance>& stances,
                     std::vector<Eigen::VectorXd>& configurations, std::size_t first,
                     std::size_t j) {
    if (ways_[j]->motion.no_arc) return false;
    const auto footing = [&](std::size_t i) { return space_.footing(stances[i]); };
    const auto found_with = [&](std::size_t i, const StanceSpace::Attempt& other) {
      if (!other.found) return false;
      StancePath path{{}, configurations};
      for (std::size_t k = 0; k < stances.size(); ++k) path.footings.push_back(footing(k));
      path.configurations[i] = other.configuration;
      hold_wheels(space_, path, i);
      std::swap(configurations, path.configurations);
      const bool found = found_at(stances, configurations, j) &&
                         (i > j || found_at(stances, configurations, j - 1));
      if (!found) std::swap(configurations, path.configurations);
      return found;
    };
    const Eigen::VectorXd begin = configurations[j], end = configurations[j + 1];
    const bool moved =
        found_with(j + 1, space_.try_nearby(footing(j), footing(j + 1), begin)) ||
        (j > first && (found_with(j, space_.try_nearby(footing(j - 1), footing(j), end)) ||
                       found_with(j, space_.try_transition(footing(j - 1), footing(j), end, 0))));
    if (!moved) {
      found_at(stances, configurations, j);
      if (j > first) found_at(stances, configurations, j - 1);
    }
    return moved;
  }

  bool found_at(const std::vector<Stance>& stances,
                const std::vector<Eigen::VectorXd>& configurations, std::size_t j) {
    ways_[j] = &solved(stances, configurations, j);
    return ways_[j]->motion.found;
  }

  Solved& solved(const std::vector<Stance>& stances,
                 const std::vector<Eigen::VectorXd>& configurations, std::size_t j) {
    const Stance none;
    const Stance& before = j == 0 ? none : stances[j - 1];
    for (const auto& known : known_) {
      if (known->from == configurations[j] && known->to == configurations[j + 1] &&
          same(known->held, stances[j]) && same(known->after, stances[j + 1]) &&
          same(known->before, before)) {
        return *known;
      }
    }
    auto fresh = std::make_unique<Solved>();
    fresh->before = before;
    fresh->held = stances[j];
    fresh->after = stances[j + 1];
    fresh->from = configurations[j];
    fresh->to = configurations[j + 1];
    move(*fresh);
    return *known_.emplace_back(std::move(fresh));
  }

  void move(Solved& solved) {
    SegmentOptions asked;
    asked.seed = stances_.seed;
    asked.deadline = stances_.deadline;
    if (!all_planners_) asked.max_states = kFewStates;
    solved.motion = {};
    on_segment(solved, [&](const Segment& segment, std::span<const BearingContact> bearing) {
      solved.motion = mover_.move(segment, bearing, solved.planner, allowed(), asked);
    });
  }

  void retime(Solved& solved) {
    on_segment(solved, [&](const Segment& segment, std::span<const BearingContact> bearing) {
      mover_.retime(segment, bearing, solved.pace, solved.motion);
    });
  }

  /// Calls f with the segment and its contacts.
  template <class F>
  void on_segment(Solved& solved, const F& f) {
    std::vector<BearingContact> bearing;
    for (const int number : space_.footing(solved.held)) {
      if (number != kFree) bearing.push_back(space_.place(number).bearing);
    }
    const double mass_kg = problem_.robot->robot->total_mass();
    const BalanceRegion region = balance_region(mass_kg, bearing, kRegionMargin);
    std::optional<TorqueProgramme> torques;
    if (problem_.check.enforce_torque_limits) {
      torques.emplace(*problem_.robot->robot, bearing, problem_.check.effort_scale, kRegionMargin);
    }
    Segment segment;
    segment.held = solved.held.contacts;
    segment.balance = &region;
    segment.torques = torques ? &*torques : nullptr;
    segment.left = besides(solved.before, solved.held);
    segment.reached = besides(solved.after, solved.held);
    segment.from = solved.from;
    segment.to = solved.to;
    plan_.whole_body_s -= solved.motion.path_s;
    plan_.timing_s -= solved.motion.timing_s;
    f(segment, bearing);
    plan_.whole_body_s += solved.motion.path_s;
    plan_.timing_s += solved.motion.timing_s;
  }

  /// Planners of segments that are tried: another way through other stances is cheaper than the
  /// dear ones, as long as there are others.
  std::size_t allowed() const {
    const std::size_t refused = static_cast<std::size_t>(plan_.refused_segments);
    const std::size_t some = 1 + refused / kRefusedForMore;
    return all_planners_ ? mover_.planners() : std::min(some, mover_.planners());
  }

  CheckReport judged(const Motion& motion, std::vector<StanceWrenches>* wrenches = nullptr) {
    const Stopwatch watch;
    CheckOptions asked = problem_.check;
    asked.threads = stances_.threads;
    if (wrenches != nullptr) {
      asked.on_balance = [wrenches](int vertex, const StanceWrenches& found) {
        (*wrenches)[static_cast<std::size_t>(vertex)] = found;
      };
    }
    CheckReport report = judge_.check(motion, asked);
    plan_.judge_s += watch.seconds();
    return report;
  }

  std::size_t segment_of(const Violation& violation) const {
    std::size_t j = 0;
    while (j + 1 < plan_.segments.size() && plan_.segments[j].last <= violation.at_vertex) ++j;
    return j;
  }

  /// Segments that hold by themselves, from rest to rest, and not one after the other: where one
  /// brakes and the next one starts, inertia of both counts. False: that is not it, or they are
  /// slow already.
  bool slow_down(std::size_t first) {
    const std::vector<const Violation*> violated = plan_.report.violated();
    if (!std::ranges::all_of(violated, [](const Violation* v) { return is_of_inertia(*v); })) {
      return false;
    }
    bool slowed = false;
    for (const Violation* violation : violated) {
      const std::size_t j = segment_of(*violation);
      const bool at_change = j > 0 && plan_.segments[j].first == violation->at_vertex;
      for (std::size_t i = at_change ? j - 1 : j; i <= j; ++i) {
        if (i >= first && slow_down(*ways_[i])) slowed = true;
      }
    }
    return slowed;
  }

  bool slow_down(Solved& solved) {
    if (solved.slowed >= kMostSlower) return false;
    ++solved.slowed;
    solved.pace.slower *= kSlower;
    solved.judged = false;
    retime(solved);
    return true;
  }

  /// Judges a segment by itself, and moves it again until it holds: slower, or by the next planner.
  /// False: it cannot be moved otherwise.
  bool mend(const std::vector<Stance>& stances, std::size_t j, bool& mended) {
    Solved& solved = *ways_[j];
    for (;;) {
      const SegmentMotion& way = solved.motion;
      Motion alone = as_motion(way);
      alone.stances = {stances[j], stances[j + 1]};
      alone.stance_from.assign(way.configurations.size(), 0);
      alone.stance_from.back() = 1;
      const CheckReport report = judged(alone);
      solved.judged = report.feasible;
      if (report.feasible) return true;
      mended = true;
      const std::vector<const Violation*> violated = report.violated();
      const bool inertia =
          std::ranges::all_of(violated, [](const Violation* v) { return is_of_inertia(*v); });
      if (inertia && slow_down(solved)) {
        // Judged again.
      } else if (!inertia && !solved.pace.finer) {
        solved.pace.finer = true;
        retime(solved);
      } else {
        solved.planner = mover_.number_of(way.planner) + 1;
        solved.pace = {};
        solved.slowed = 0;
        if (solved.planner < allowed()) move(solved);
      }
      if (solved.planner >= allowed() || !solved.motion.found) {
        solved.motion.found = false;
        solved.motion.reason = "refused: " + violation_text(report.worst());
        return false;
      }
    }
  }

  const StanceProblem& problem_;
  const StancePlannerOptions stances_;
  MotionPlan& plan_;
  StanceSpace space_;
  SegmentMover mover_;
  bool all_planners_;  ///< from the first segment on
  Judge judge_;
  std::vector<std::unique_ptr<Solved>> known_;
  std::vector<Solved*> ways_;
  std::string refused_reason_;
};

}  // namespace

MotionPlan plan_motion(const StanceProblem& problem, const StancePlannerOptions& stances,
                       const MotionOptions& options) {
  const Stopwatch watch;
  MotionPlan plan;
  MotionSearch search(problem, stances, options, plan);
  StancePlannerOptions asked = stances;
  asked.accept = [&](const auto& of, auto& configurations, std::size_t first) {
    return search.accept(of, configurations, first);
  };
  plan.stances = make_stance_planner(options.stance_planner)->plan(problem, asked);
  plan.success = plan.stances.success;
  plan.reason = plan.stances.reason;
  if (!plan.success) {
    if (!search.refused_reason().empty()) {
      plan.reason += "; the last motion that was not found: " + search.refused_reason();
    }
    plan.report = {};
    search.keep(plan.stances.configurations.size() - 1);
    search.assemble(plan.stances.stances, plan.stances.configurations);
  }
  plan.total_s = watch.seconds();
  return plan;
}

}  // namespace locograph
