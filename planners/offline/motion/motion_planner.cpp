#include <locograph/check/judge.h>
#include <locograph/planners/balance/margin_contacts.h>
#include <locograph/planners/offline/motion/motion_assembly.h>
#include <locograph/planners/offline/motion/motion_planner.h>
#include <locograph/planners/offline/stance/stance_planners.h>
#include <locograph/planners/offline/stance/standing_wheels.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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
/// Of the centre of mass, where both ends of a segment have none to the sides of its polygon.
constexpr double kRoomAtEnds_m = 2e-3;

/// Segments whose forces change too fast are slowed down so often, at first only in places.
constexpr int kMostEased = 12, kMostEasedInPlaces = 5;
/// Until they take so many times as long; at each time speeds fall to half at most.
constexpr double kMostLonger = 4.0, kMostRatio = 8.0;

/// What one segment came to be, to be looked up when the stance planner comes back to it.
struct TriedSegment : LoadedSegment {
  Footing before, held, after;  ///< before: empty where the motion begins
  Eigen::VectorXd from, to;
  std::size_t planner = 0;  ///< the first one that has not been refused
  SegmentPace pace;
  int slowed = 0;
  bool judged = false;     ///< and found feasible, by itself
  ExecutionMargin margin;  ///< what its ends, which are given, leave of the task's
};

bool is_of_inertia(const Violation& violation) {
  return violation.constraint == "static_balance" || violation.constraint == "torque_limits";
}

class MotionSearch {
 public:
  MotionSearch(StanceSpace& space, const StancePlannerOptions& stances,
               const MotionOptions& options, MotionPlan& plan)
      : task_(space.task()),
        stances_(stances),
        plan_(plan),
        space_(space),
        mover_(task_, options),
        all_planners_(!options.segment_planners.empty()),
        judge_(task_.robot->robot, task_.world),
        state_(*task_.robot->robot),
        loads_(*task_.robot->robot),
        assembly_(space),
        smoothing_s_(options.loaded_smoothing_s) {}

  /// Moves along a way through stances. 0: it does, maybe between other configurations than the
  /// way came with, from change number `first` + 1 on; else the number of a change that will not
  /// do.
  std::size_t move_along(StancePath& way, std::size_t first) {
    const std::size_t count = way.changes();
    ways_.resize(count, nullptr);
    for (bool whole = false;; whole = true) {
      for (std::size_t j = first; j < count; ++j) {
        if (!found_at(way, j) && !move_postures(way, first, j)) return refuse(j);
        // Those before, too: one of them may have been moved.
        for (std::size_t i = first; assembly_.bears_on() && i <= j; ++i) {
          if (!load(*ways_[i])) return refuse(i);
        }
      }
      assemble(way);
      plan_.report = judged(plan_.motion);
      if (plan_.report.feasible) return 0;
      // At first those only that the report names: of each constraint one.
      std::vector<bool> named(count, whole);
      for (const Violation* violation : plan_.report.violated()) {
        named[segment_of(*violation)] = true;
      }
      bool mended = false;
      for (std::size_t j = first; j < count; ++j) {
        if (ways_[j]->judged || !named[j]) continue;
        if (!mend(j, mended)) return refuse(j);
        way.configurations[j + 1] = ways_[j]->motion.to;
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
  void assemble(const StancePath& path) {
    const std::vector<const LoadedSegment*> segments(ways_.begin(), ways_.end());
    assembly_.assemble(path, segments, plan_.motion, plan_.segments);
  }

  /// Why the last one was refused; empty: none was.
  const std::string& refused_reason() const { return refused_reason_; }

  void keep(std::size_t segments) { ways_.resize(std::min(segments, ways_.size())); }

 private:
  std::size_t refuse(std::size_t segment) {
    ++plan_.statistics.refused_segments;
    refused_reason_ = ways_[segment]->motion.reason;
    return segment + 1;
  }

  /// Makes forces change less fast: slower where they do, as they change by the third power of
  /// speed where the path bends.
  void slow_where_forces_change(const SegmentLoads& loads, TriedSegment& tried) const {
    constexpr std::size_t kPlaces = 101;
    constexpr double kMore = 0.97, kSteepest = 1.15;  // of speeds, from place to place
    const SegmentMotion& way = tried.motion;
    std::vector<double>& most = tried.pace.most_speed;
    if (most.empty()) most.assign(kPlaces, 1.5 * *std::ranges::max_element(way.speed));
    const auto place = [](double share) {
      return std::min(kPlaces - 1, static_cast<std::size_t>(share * (kPlaces - 1)));
    };
    const auto last = static_cast<std::ptrdiff_t>(loads.rates.size());
    const auto around = static_cast<std::ptrdiff_t>(
        std::ceil(0.5 * smoothing_s_ / way.duration_s * static_cast<double>(last)));
    for (std::ptrdiff_t i = 0; i < last; ++i) {
      const double ratio =
          std::min(kMostRatio, loads.rates[static_cast<std::size_t>(i)] / kFastestLoad);
      if (ratio <= 1.0) continue;
      const std::ptrdiff_t from = std::max<std::ptrdiff_t>(0, i - around);
      const std::ptrdiff_t to = std::min(last, i + 1 + around);
      const double speed = kMore / std::cbrt(ratio) *
                           *std::max_element(way.speed.begin() + from, way.speed.begin() + to + 1);
      const std::size_t end = place(way.share[static_cast<std::size_t>(to)]) + 1;
      for (std::size_t k = place(way.share[static_cast<std::size_t>(from)]);
           k <= std::min(end, kPlaces - 1); ++k) {
        most[k] = std::min(most[k], speed);
      }
    }
    for (std::size_t k = 1; k < kPlaces; ++k) {
      most[k] = std::min(most[k], kSteepest * most[k - 1]);
    }
    for (std::size_t k = kPlaces - 1; k > 0; --k) {
      most[k - 1] = std::min(most[k - 1], kSteepest * most[k]);
    }
  }

  /// Finds the wrenches along a segment: slower where they change too fast or do not hold, then
  /// with less of the margin. False: there are none.
  bool load(TriedSegment& tried) {
    if (!tried.wrenches.empty()) return true;
    const std::vector<BearingContact> bearing = space_.bearing_contacts(tried.held);
    ExecutionMargin margin = tried.margin;
    std::size_t share = 0;
    const double most_s = kMostLonger * tried.motion.duration_s;
    for (int attempt = 0;; ++attempt) {
      if (const auto end = end_by(stances_.termination)) {
        static_cast<PlannerAnswer&>(tried.motion) = *end;
        return false;
      }
      auto found = loads_.along(counted(bearing, margin), assembly_.effort_scale(margin),
                                as_motion(tried.motion));
      if (found && found->fastest <= kFastestLoad) {
        tried.wrenches = std::move(found->wrenches);
        return true;
      }
      if (attempt < kMostEased && tried.motion.duration_s < most_s) {
        if (!found || attempt >= kMostEasedInPlaces) {
          tried.pace.slower *=
              found ? 1.03 * std::cbrt(std::min(kMostRatio, found->fastest / kFastestLoad))
                    : kSlower;
        }
        if (found && !tried.motion.speed.empty()) slow_where_forces_change(*found, tried);
        tried.judged = false;
        retime(tried);
        continue;
      }
      if (found || ++share == kPartsOfMargin.size()) {
        tried.motion.status = PlannerStatus::kNotFound;
        tried.motion.reason =
            found ? "forces at its contacts change too fast" : "no wrenches hold it along its way";
        return false;
      }
      margin = tried.margin.scaled(kPartsOfMargin[share]);
    }
  }

  /// Other postures at an end of segment j, near the one at its other end: where free arms are on
  /// different sides of a bar there is no short way. False: none makes it found; nothing is
  /// changed.
  bool move_postures(StancePath& path, std::size_t first, std::size_t j) {
    if (ways_[j]->motion.no_arc) return false;
    const std::vector<Footing>& footings = path.footings;
    const auto found_with = [&](std::size_t i, const StanceSpace::Attempt& other) {
      if (!other.found) return false;
      std::vector<Eigen::VectorXd> as_they_were = path.configurations;
      path.configurations[i] = other.configuration;
      hold_wheels(space_, path, i);
      const bool found = (i > j || found_at(path, j - 1)) && found_at(path, j);
      if (!found) path.configurations = std::move(as_they_were);
      return found;
    };
    const Eigen::VectorXd begin = path.configurations[j], end = path.configurations[j + 1];
    const auto nearby = [&](std::size_t i, const Eigen::VectorXd& q) {
      return space_.try_nearby(footings[i - 1], footings[i], q, &path.configurations[i - 1]);
    };
    const bool moved =
        found_with(j + 1, nearby(j + 1, begin)) ||
        (j > first && (found_with(j, nearby(j, end)) ||
                       found_with(j, space_.try_again(footings[j - 1], footings[j], end,
                                                      &path.configurations[j - 1]))));
    if (!moved) {
      if (j > first) found_at(path, j - 1);
      found_at(path, j);
    }
    return moved;
  }

  /// Moves through stance j, whose end becomes where the motion gets to.
  bool found_at(StancePath& path, std::size_t j) {
    TriedSegment* known = known_at(path, j);
    if (known == nullptr && !rolls_to(path, j + 1)) {
      known = &add_tried(path, j);
      known->motion.reason = "a ball does not roll to where it is held";
    }
    if (known == nullptr) known = known_at(path, j);
    if (known == nullptr) {
      known = &add_tried(path, j);
      move(*known);
    }
    ways_[j] = known;
    if (!known->motion.success()) return false;
    path.configurations[j + 1] = known->motion.to;
    return true;
  }

  /// Finds the configuration of a change again where balls slip since the one before.
  bool rolls_to(StancePath& path, std::size_t change) {
    const Eigen::VectorXd as_it_was = path.configurations[change];
    if (!roll_to(space_, path.footings[change - 1], path.footings[change],
                 path.configurations[change - 1], path.configurations[change])) {
      return false;
    }
    if (path.configurations[change] != as_it_was) hold_wheels(space_, path, change);
    return true;
  }

  TriedSegment* known_at(const StancePath& path, std::size_t j) const {
    const Eigen::VectorXd &from = path.configurations[j], &to = path.configurations[j + 1];
    const Footing before = before_of(path, j);
    for (const auto& known : known_) {
      const bool moved = known->motion.to.size() > 0;
      const bool ends_there = known->to == to || (moved && known->motion.to == to);
      if (known->from == from && ends_there && known->held == path.footings[j] &&
          known->after == path.footings[j + 1] && known->before == before) {
        return known.get();
      }
    }
    return nullptr;
  }

  TriedSegment& add_tried(const StancePath& path, std::size_t j) {
    auto fresh = std::make_unique<TriedSegment>();
    fresh->before = before_of(path, j);
    fresh->held = path.footings[j];
    fresh->after = path.footings[j + 1];
    fresh->from = path.configurations[j];
    fresh->to = path.configurations[j + 1];
    fresh->margin = margin_of(*fresh);
    return *known_.emplace_back(std::move(fresh));
  }

  static Footing before_of(const StancePath& path, std::size_t j) {
    return j == 0 ? Footing() : path.footings[j - 1];
  }

  /// Ends are found with the execution margin but for the start and the goals; what they do not
  /// have is not asked of the way between them, either.
  ExecutionMargin margin_of(const TriedSegment& tried) {
    if (task_.margin == ExecutionMargin::none()) return task_.margin;
    const std::vector<BearingContact> bearing = space_.bearing_contacts(tried.held);
    const Robot& robot = *task_.robot->robot;
    ExecutionMargin margin = task_.margin;
    double torque = 0.0, share = 1.0;
    for (const Eigen::VectorXd* q : {&tried.from, &tried.to}) {
      state_.update(q->data());
      const Eigen::Vector2d centre = state_.center_of_mass().head<2>();
      share = std::min(share, share_of_margin(robot.total_mass(), rolled_to(state_, bearing),
                                              task_.margin, {&centre, 1}));
      margin.joint_rad = std::min(margin.joint_rad, robot.joint_room(*q));
    }
    const ExecutionMargin had = task_.margin.scaled(share);
    margin.friction = had.friction;
    margin.area = had.area;
    margin.least_force = had.least_force;
    if (!task_.check.enforce_torque_limits) return margin;
    TorqueProgramme torques(robot, counted(bearing, margin), task_.check.effort_scale,
                            kRegionMargin);
    Eigen::VectorXd gradient;
    for (const Eigen::VectorXd* q : {&tried.from, &tried.to}) {
      state_.update(q->data());
      torque = std::max(torque, torques.solve(state_, gradient));
    }
    margin.torque =
        std::clamp(torque / (1.0 - TransitionOptions().torque_margin), margin.torque, 1.0);
    return margin;
  }

  std::vector<BearingContact> counted(std::span<const BearingContact> bearing,
                                      const ExecutionMargin& margin) const {
    const double weight_N = task_.robot->robot->total_mass() * standard_gravity().norm();
    return with_margin(bearing, margin, weight_N);
  }

  void move(TriedSegment& tried) {
    SegmentOptions asked;
    asked.seed = stances_.seed;
    asked.termination = stances_.termination;
    asked.termination.max_iterations = 0;  // is of stances
    if (!all_planners_) asked.max_states = kFewStates;
    tried.motion = {};
    tried.wrenches.clear();
    on_segment(tried, [&](const Segment& segment, std::span<const BearingContact> bearing) {
      tried.motion = mover_.move(segment, bearing, tried.planner, allowed(), asked);
    });
  }

  void retime(TriedSegment& tried) {
    tried.wrenches.clear();
    on_segment(tried, [&](const Segment& segment, std::span<const BearingContact> bearing) {
      mover_.retime(segment, bearing, tried.pace, tried.motion);
    });
  }

  /// Contacts of `of` whose end effectors are not in `held`.
  std::vector<Contact> besides(Footing of, const Footing& held) const {
    for (std::size_t e = 0; e < of.size(); ++e) {
      if (held[e] != kFree) of[e] = kFree;
    }
    return space_.stance(of).contacts;
  }

  /// Calls f with the segment and its contacts.
  template <class F>
  void on_segment(TriedSegment& tried, const F& f) {
    const std::vector<BearingContact> bearing =
        counted(space_.bearing_contacts(tried.held), tried.margin);
    const BalanceRegion region = region_of(tried, bearing);
    std::optional<TorqueProgramme> torques;
    if (task_.check.enforce_torque_limits) {
      torques.emplace(*task_.robot->robot, bearing, task_.check.effort_scale * tried.margin.torque,
                      kRegionMargin);
    }
    Segment segment;
    segment.held = space_.stance(tried.held).contacts;
    segment.balance = &region;
    segment.torques = torques ? &*torques : nullptr;
    segment.left = besides(tried.before, tried.held);
    state_.update(tried.from.data());
    for (Contact& contact : segment.left) contact = rolled_to(state_, contact);
    segment.reached = besides(tried.after, tried.held);
    segment.from = tried.from;
    segment.to = tried.to;
    segment.joint_margin_rad = tried.margin.joint_rad;
    segment.self_margin_m = tried.margin.self_distance_m;
    segment.torque_share = tried.margin.torque;
    plan_.statistics.path_s -= tried.motion.statistics.path_s;
    plan_.statistics.timing_s -= tried.motion.statistics.timing_s;
    f(segment, bearing);
    plan_.statistics.path_s += tried.motion.statistics.path_s;
    plan_.statistics.timing_s += tried.motion.statistics.timing_s;
  }

  /// Where balls roll, about places half-way, and wide enough for both ends: these balance where
  /// balls are then, and the judge looks at all in between.
  BalanceRegion region_of(const TriedSegment& tried, std::vector<BearingContact> bearing) {
    const double mass_kg = task_.robot->robot->total_mass();
    const bool rolls =
        std::ranges::any_of(bearing, [](const auto& one) { return is_ball(one.contact.effector); });
    if (!rolls) return balance_region(mass_kg, bearing, kRegionMargin);
    state_.update(tried.from.data());
    const std::vector<BearingContact> from = rolled_to(state_, bearing);
    std::vector<Eigen::Vector2d> centres = {state_.center_of_mass().head<2>()};
    state_.update(tried.to.data());
    const std::vector<BearingContact> to = rolled_to(state_, bearing);
    centres.emplace_back(state_.center_of_mass().head<2>());
    for (std::size_t i = 0; i < bearing.size(); ++i) {
      if (!is_ball(bearing[i].contact.effector)) continue;
      bearing[i].contact.position = 0.5 * (from[i].contact.position + to[i].contact.position);
      bearing[i].contact.normal = from[i].contact.normal + to[i].contact.normal;
    }
    BalanceRegion region = balance_region(mass_kg, bearing, kRegionMargin);
    for (BalanceRegion::Side& side : region.sides) {
      for (const Eigen::Vector2d& centre : centres) {
        side.offset_m = std::max(side.offset_m, side.normal.dot(centre) + kRoomAtEnds_m);
      }
    }
    return region;
  }

  /// Planners of segments that are tried: another way through other stances is cheaper than the
  /// dear ones, as long as there are others.
  std::size_t allowed() const {
    const std::size_t refused = static_cast<std::size_t>(plan_.statistics.refused_segments);
    const std::size_t some = 1 + refused / kRefusedForMore;
    return all_planners_ ? mover_.planners() : std::min(some, mover_.planners());
  }

  CheckReport judged(const Motion& motion) {
    const Stopwatch watch;
    CheckOptions asked = task_.check;
    asked.threads = stances_.threads;
    CheckReport report = judge_.check(motion, asked);
    plan_.statistics.judge_s += watch.seconds();
    return report;
  }

  std::size_t segment_of(const Violation& violation) const {
    std::size_t j = 0;
    while (j + 1 < ways_.size() && plan_.segments[j].last <= violation.at_vertex) ++j;
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

  bool slow_down(TriedSegment& tried) {
    if (tried.slowed >= kMostSlower) return false;
    ++tried.slowed;
    tried.pace.slower *= kSlower;
    tried.judged = false;
    retime(tried);
    return true;
  }

  /// Judges a segment by itself, and moves it again until it holds: slower, or by the next planner.
  /// False: it cannot be moved otherwise.
  bool mend(std::size_t j, bool& mended) {
    TriedSegment& tried = *ways_[j];
    for (;;) {
      const SegmentMotion& way = tried.motion;
      Motion alone = as_motion(way);
      alone.stances = {space_.rolled_stance(tried.held, tried.held, tried.from),
                       space_.rolled_stance(tried.after, tried.held, tried.from)};
      alone.stance_from.assign(way.configurations.size(), 0);
      alone.stance_from.back() = 1;
      const CheckReport report = judged(alone);
      tried.judged = report.feasible;
      if (report.feasible) return true;
      mended = true;
      const std::vector<const Violation*> violated = report.violated();
      const bool inertia =
          std::ranges::all_of(violated, [](const Violation* v) { return is_of_inertia(*v); });
      if (inertia && slow_down(tried)) {
        // Judged again.
      } else if (!inertia && !tried.pace.finer) {
        tried.pace.finer = true;
        retime(tried);
      } else {
        tried.planner = mover_.number_of(way.planner) + 1;
        tried.pace = {};
        tried.slowed = 0;
        if (tried.planner < allowed()) move(tried);
      }
      if (tried.planner >= allowed() || !tried.motion.success()) {
        tried.motion.status = PlannerStatus::kNotFound;
        tried.motion.reason = "refused: " + violation_text(report.worst());
        return false;
      }
    }
  }

  const Task& task_;
  const StancePlannerOptions& stances_;
  MotionPlan& plan_;
  StanceSpace& space_;
  SegmentMover mover_;
  bool all_planners_;  ///< from the first segment on
  Judge judge_;
  RobotState state_;
  MotionLoads loads_;
  MotionAssembly assembly_;
  double smoothing_s_;
  std::vector<std::unique_ptr<TriedSegment>> known_;
  std::vector<TriedSegment*> ways_;
  std::string refused_reason_;
};

}  // namespace

MotionPlan plan_motion(const Task& task, const StancePlannerOptions& stances,
                       const MotionOptions& options) {
  options.validate();
  const Stopwatch watch;
  MotionPlan plan;
  StancePlannerOptions asked = stances;
  asked.approachable_only = true;
  const auto planner = make_stance_planner(options.stance_planner);
  const std::unique_ptr<StanceSearch> search = planner->begin(task, asked);
  MotionSearch motions(search->space(), asked, options, plan);
  while (search->next()) {
    StancePath way = search->candidate();
    const std::size_t refused = motions.move_along(way, search->taken().changes());
    if (refused > 0) {
      search->refuse(refused, "no motion for one of its stances");
    } else {
      search->replace(std::move(way.configurations));
      search->take();
    }
  }
  plan.stances = search->result();
  plan.status = plan.stances.status;
  plan.reason = plan.stances.reason;
  if (!plan.success()) {
    if (!motions.refused_reason().empty()) {
      plan.reason += "; the last motion that was not found: " + motions.refused_reason();
    }
    plan.report = {};
    motions.keep(search->taken().changes());
    motions.assemble(search->taken());
  }
  plan.statistics.iterations = plan.stances.statistics.iterations;
  plan.statistics.total_s = watch.seconds();
  return plan;
}

}  // namespace locograph
