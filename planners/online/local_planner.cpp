#include <locograph/common/check_option.h>
#include <locograph/planners/online/local_planner.h>
#include <locograph/planners/online/window_cause.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace locograph {
namespace {

/// Of a proposal's search, see Proposal::search(): some 0.2 ms.
constexpr int kSlice = 40;
/// Cycles that do not move the window, before one that does: as many as are counted.
constexpr int kRested = 3;

Horizon horizon_of(const LocalPlannerOptions& options) {
  return {options.horizon, options.horizon_s};
}

}  // namespace

void LocalPlannerOptions::validate() const {
  horizon_of(*this).validate();
  solver.validate();
  check_option(proposal_pause >= 0, "proposal_pause", "0 or more");
}

LocalPlanner::LocalPlanner(Graph& graph, const LocalPlannerOptions& options)
    : options_(options),
      plan_(graph),
      window_(plan_, horizon_of(options)),
      warm_start_(plan_),
      solver_(options.solver),
      proposals_(options.proposals, plan_, options.proposal_pause),
      fallbacks_(options.fallbacks, plan_, 0) {
  options.validate();
  answer_.executed = -1;
  // Memory, the lists of edges and the order of elimination now rather than in the first cycle.
  if (plan_.size() < 2) return;
  Window first = window_;  // a copy: nothing has entered the planner's own
  // Windows away from the start have a few rows more than the first one.
  constexpr int kAway = 4;
  for (const int executed : {std::min(kAway, plan_.size() - 2), 0}) {
    first.move_to(executed);
    solver_.compile(first, false);
    solver_.load_state();
    solver_.prepare();
  }
  // As a window that slides is, some times over: what is taken over has its memory, too.
  constexpr int kTimes = 4;
  for (int times = 0; times < kTimes; ++times) {
    first.move_to(plan_.size() > 2 ? times % 2 : 0);
    solver_.compile(first, true);
    solver_.load_state();
    solver_.quality();
  }
}

void LocalPlanner::show(std::shared_ptr<const WorldSnapshot> world) {
  world->distance();
  auto shown = std::make_shared<const WorldParameter>(world, plan_.plan().world->ground_z_m);
  const std::lock_guard lock(showing_);
  if (world->stamp_s() < shown_stamp_s_) {
    throw Error("a snapshot of " + std::to_string(world->stamp_s()) + " s",
                std::to_string(shown_stamp_s_) + " s or later, as the last one that was shown");
  }
  shown_stamp_s_ = world->stamp_s();
  shown_ = std::move(shown);
}

void LocalPlanner::measure(const Eigen::VectorXd& configuration) {
  constexpr double kUnit = 1e-3, kRounding = 1e-14;
  const Robot& robot = plan_.robot();
  const std::string what = "a measured configuration";
  if (configuration.size() != robot.configuration_size()) {
    throw Error(what + " of " + std::to_string(configuration.size()) + " numbers",
                std::to_string(robot.configuration_size()) + " of " + robot.name());
  }
  if (!configuration.allFinite()) throw Error(what + " that is not finite", "finite numbers");
  Eigen::VectorXd q = configuration;
  if (robot.floating_base()) {
    const double norm = q.segment<4>(3).norm();
    if (!(std::abs(norm - 1.0) <= kUnit)) {
      throw Error(what + " whose quaternion has the norm " + std::to_string(norm), "1");
    }
    if (std::abs(norm - 1.0) > kRounding) q.segment<4>(3) /= norm;
  }
  const std::lock_guard lock(showing_);
  measured_ = std::move(q);
}

/// Empty: none.
Eigen::VectorXd LocalPlanner::take_measured() {
  const std::lock_guard lock(showing_);
  return std::exchange(measured_, {});
}

/// Whether there was something new.
bool LocalPlanner::take_shown() {
  std::shared_ptr<const WorldParameter> world;
  {
    const std::lock_guard lock(showing_);
    world = std::move(shown_);
    shown_ = nullptr;
  }
  if (!world) return false;
  plan_.show(std::move(world));
  proposals_.world_changed();
  fallbacks_.world_changed();
  return true;
}

bool LocalPlanner::begin_window(int executed) {
  require_step(executed);
  take_shown();
  changed_ = true;
  move_window(executed, take_measured());
  hand_out_best();
  changed_ = true;
  return incumbent_.best().quality.feasible();
}

void LocalPlanner::require_step(int executed) const {
  if (executed >= 0 && executed + 1 < plan_size()) return;
  throw Error("executed configuration " + std::to_string(executed),
              "0 to " + std::to_string(plan_size() - 2));
}

CycleReport LocalPlanner::cycle(int executed, const Termination& termination) {
  require_step(executed);
  termination.validate();
  CycleReport report;
  report.executed = executed;
  const Stopwatch watch;
  const bool new_world = take_shown();
  const Eigen::VectorXd measured = take_measured();
  const bool moved = changed_ || answer_.executed != executed || measured.size() > 0;
  const int rested = std::exchange(rested_, moved ? 0 : std::min(rested_ + 1, kRested));
  if (phase_ == Phase::kOver && !moved && !new_world && !tries_again()) {
    report = answer_;
    report.detour = report.deadline_missed = false;
    report.statistics = {};
    report.statistics.constraints = answer_.statistics.constraints;
    report.statistics.total_s = watch.seconds();
    return report;
  }
  if (moved || new_world) begin(report, moved, measured);
  report.window = window_.steps();
  report.statistics.constraints = static_cast<int>(solver_.problem().constraints().size());
  const int cut_short_after = moved && rested >= kRested ? improve_after_move(report, termination)
                                                         : improve(report, termination);
  hand_out_best();
  describe_best(report);
  const auto end = ended_as(termination, cut_short_after);
  if (cut_short_after > 0 && end && !report.success()) {
    report.status = *end;
    report.cut_short = true;
  }
  report.statistics.total_s = watch.seconds();
  report.deadline_missed = termination.deadline.passed();
  answer_ = report;
  return report;
}

/// A search that has led to a better window than the one before, but to none that is feasible, is
/// begun once more.
bool LocalPlanner::tries_again() {
  const WindowQuality& best = incumbent_.best().quality;
  if (best.feasible() || !best.better_than(tried_)) return false;
  tried_ = best;
  solver_.set_state(incumbent_.least_violating().state);
  left_over_ = incumbent_.least_violating().state != incumbent_.best().state;
  enter(Phase::kOptimise);
  return true;
}

/// At another configuration, or in another world. What the search had come to goes on from there;
/// one that is over, or whose window is good as it is, begins anew.
void LocalPlanner::begin(CycleReport& report, bool moved, const Eigen::VectorXd& measured) {
  const Stopwatch watch;
  const bool goes_on = phase_ != Phase::kOver &&
                       (phase_ != Phase::kOptimise ||
                        !(incumbent_.best().state.empty() || incumbent_.best().quality.feasible()));
  tried_ = {};
  left_over_ = false;
  if (moved) {
    left_over_ = move_window(report.executed, measured);
  } else {
    see_new_world();
  }
  report.statistics.compile_s = watch.seconds();
  const bool good = is_good();
  left_over_ = left_over_ && !good;
  if (left_over_) {
    warm_start_.load_unfinished(window_);
    solver_.load_state();
    better_ = true;  // the graph has another window now
  }
  warm_start_.drop_unfinished();
  if (goes_on && !good) return;
  proposals_.give_up();
  fallbacks_.give_up();
  if (phase_ != Phase::kOptimise) solver_.end_run();  // it may be one that raises
  if (!moved) {
    const WindowCandidate& from = good ? incumbent_.best() : incumbent_.least_violating();
    left_over_ = from.state != incumbent_.best().state;
    solver_.set_state(from.state);
  }
  enter(Phase::kOptimise);
}

/// The window that the search goes on from, where it is not the one that was handed out: that of
/// the run, or else the least violating one. Null: none.
const std::vector<double>* LocalPlanner::leftover() {
  return incumbent_.unfinished(solver_.running() ? &solver_.state() : nullptr);
}

/// measured: see measure(); empty: nothing. Returns whether there is something left over, which is
/// kept as unfinished.
bool LocalPlanner::move_window(int executed, const Eigen::VectorXd& measured) {
  if (answer_.executed >= 0) {
    if (const std::vector<double>* state = leftover()) {
      solver_.store(*state);
      warm_start_.keep_unfinished(window_);
      solver_.store(incumbent_.best().state);
    }
  }
  window_.move_to(executed);
  warm_start_.enter(window_);
  constexpr double kOff = 1e-9;  // m, rad
  if (measured.size() > 0 &&
      (measured - plan_.configuration(executed)).lpNorm<Eigen::Infinity>() > kOff) {
    const Eigen::VectorXd was = plan_.configuration(executed);
    plan_.move_to(executed, measured, window_.first_held());
    plan_.take_contacts(executed);
    warm_start_.lead_back(window_, was);
  }
  const bool slid = !changed_ && answer_.executed >= 0 && plan_.revision() == revision_;
  if (plan_.forget_moved() || changed_) {  // what searches know of it does not hold any more
    for (ProposalSchedule* schedule : {&proposals_, &fallbacks_}) {
      schedule->give_up();
      schedule->world_changed();
    }
  }
  revision_ = plan_.revision();
  solver_.compile(window_, slid);
  changed_ = false;
  solver_.load_state();
  incumbent_.clear();
  beside_.clear();
  incumbent_.offer(solver_.quality(), solver_.state());
  better_ = true;  // other configurations are handed out
  return warm_start_.has_unfinished();
}

/// What the search has come to stays as it is; what it has found is looked at anew.
void LocalPlanner::see_new_world() {
  solver_.rebind(plan_.bindings());
  for (Incumbent* incumbent : {&incumbent_, &beside_}) {
    if (incumbent->best().state.empty()) continue;
    handed_out_ = incumbent->best().state;
    least_ = incumbent->least_violating().state;
    incumbent->clear();
    incumbent->offer(solver_.quality_of(handed_out_), handed_out_);
    if (solver_.running() || least_ == handed_out_) continue;
    const bool better = incumbent->offer(solver_.quality_of(least_), least_);
    better_ = better_ || (better && incumbent == &incumbent_);
  }
}

/// Where most cycles do not move the window, moving it is the first step of one that does, unless
/// the next configuration needs more.
int LocalPlanner::improve_after_move(CycleReport& report, const Termination& termination) {
  Termination left = termination;
  if (left.max_iterations == 0 || incumbent_.best().quality.feasible_steps < 1) {
    return improve(report, termination);
  }
  if (--left.max_iterations > 0) {
    const int cut_short_after = improve(report, left);
    return cut_short_after > 0 ? cut_short_after + 1 : 0;
  }
  rest_if_as_planned();
  return phase_ == Phase::kOver ? 0 : 1;
}

/// Step by step. Returns after how many of them it was cut short; 0: it was not.
int LocalPlanner::improve(CycleReport& report, const Termination& termination) {
  rest_if_as_planned();
  int steps = 0;
  for (; phase_ != Phase::kOver; ++steps) {
    if (steps > 0 && termination.ended(steps)) {
      if (solver_.running()) offer();
      return steps;
    }
    if (!advance(report, termination)) break;
  }
  return phase_ == Phase::kPropose || phase_ == Phase::kFallBack ? steps + 1 : 0;
}

void LocalPlanner::rest_if_as_planned() {
  if (phase_ == Phase::kOptimise && !solver_.running() && is_good() && is_as_planned()) {
    phase_ = Phase::kOver;
  }
}

/// One step of the search. False where the cycle may rest: its window is feasible, and the last
/// step made it hardly better, or a proposal is not finished.
bool LocalPlanner::advance(CycleReport& report, const Termination& termination) {
  if (phase_ != Phase::kPropose && phase_ != Phase::kFallBack) return run(report, termination);
  return propose(report, termination) && phase_ != Phase::kOptimise;
}

bool LocalPlanner::run(CycleReport& report, const Termination& termination) {
  using Start = WindowSolver::Start;
  const bool raises = phase_ == Phase::kRaise || phase_ == Phase::kRaiseFallback;
  const bool optimises = phase_ == Phase::kOptimise;
  if (!solver_.running()) {
    if (!optimises || left_over_) offer();
    if (raises) {
      solver_.begin_raising();
    } else {
      solver_.begin(optimises && !left_over_ ? Start::kIncumbent : Start::kCandidate);
    }
  }
  const bool more = solver_.step(termination, report.statistics);
  ++iterations_;
  const WindowSolverOptions& options = options_.solver;
  const int most = options.max_iterations * (raises ? options.max_rounds + 2 : 1);
  if (more && iterations_ < most) {
    if (raises || !solver_.gained_little() || !solver_.quality().feasible()) return true;
    if (optimises) {
      offer();
      return !is_good();  // or else the run goes on with the next cycle
    }
  }
  end_run();
  return phase_ != Phase::kOptimise;
}

/// Of the phase, with what it has led to.
void LocalPlanner::end_run() {
  solver_.end_run();
  const bool better = offer();
  switch (phase_) {
    case Phase::kOptimise:
      if (wants_proposals()) {
        asked_ = 0;
        helped_ = false;
        enter(Phase::kPropose);
      } else {
        raise_or_fall_back();
      }
      break;
    case Phase::kFollow:
      helped_ = helped_ || better;
      if (asked_ < proposals_.size()) {
        enter(Phase::kPropose);
      } else {
        go_on_after_proposals();
      }
      break;
    case Phase::kRaise:
      proposals_.pause_after(window_.executed());
      fall_back();
      break;
    case Phase::kFollowFallback:
      if (options_.solver.max_rounds > 0 && !beside_.best().quality.feasible()) {
        solver_.set_state(beside_.least_violating().state);
        enter(Phase::kRaiseFallback);
      } else {
        end_fallback();
      }
      break;
    case Phase::kRaiseFallback:
      end_fallback();
      break;
    default:
      break;
  }
}

void LocalPlanner::end_fallback() {
  better_ = incumbent_.offer(beside_.best().quality, beside_.best().state) || better_;
  beside_.clear();
  enter(is_good() || asked_ == fallbacks_.size() ? Phase::kOver : Phase::kFallBack);
}

/// A slice of a proposal's search, or all of it. Whether that is finished.
bool LocalPlanner::propose(CycleReport& report, const Termination& termination) {
  const Stopwatch watch;
  const bool falls_back = phase_ == Phase::kFallBack;
  ProposalSchedule& schedule = falls_back ? fallbacks_ : proposals_;
  Termination slice = termination;
  if (slice.max_iterations > 0) slice.max_iterations = kSlice;
  report.detour = true;
  const Proposal::Answer answer = schedule.ask(plan_, window_, slice, candidate_);
  if (answer != Proposal::Answer::kUnfinished) ++asked_;
  if (answer == Proposal::Answer::kFound) {
    plan_.overwrite(window_.first(), candidate_);
    better_ = true;  // the graph has another window now
    solver_.load_state();
    beside_.clear();
    enter(falls_back ? Phase::kFollowFallback : Phase::kFollow);
  } else if (answer == Proposal::Answer::kNone && asked_ == schedule.size()) {
    if (falls_back) {
      enter(Phase::kOver);
    } else {
      go_on_after_proposals();
    }
  }
  report.statistics.proposals_s += watch.seconds();
  return answer != Proposal::Answer::kUnfinished;
}

void LocalPlanner::go_on_after_proposals() {
  if (!helped_) proposals_.pause_after(window_.executed());
  if (!is_good()) {
    raise_or_fall_back();
    return;
  }
  solver_.set_state(incumbent_.best().state);
  enter(Phase::kOptimise);
}

void LocalPlanner::raise_or_fall_back() {
  if (incumbent_.best().quality.feasible() || options_.solver.max_rounds == 0) {
    fall_back();
    return;
  }
  solver_.set_state(incumbent_.least_violating().state);
  enter(Phase::kRaise);
}

void LocalPlanner::fall_back() {
  asked_ = 0;
  const bool has_to = !incumbent_.best().quality.feasible() && fallbacks_.size() > 0;
  enter(has_to ? Phase::kFallBack : Phase::kOver);
}

void LocalPlanner::enter(Phase phase) {
  phase_ = phase;
  iterations_ = 0;
}

/// Whether the incumbent needs no proposals. It is in the graph then.
bool LocalPlanner::is_good() {
  hand_out_best();
  return incumbent_.best().quality.feasible() &&
         !(plan_.behind_m(window_.last()) > options_.blocked_m);
}

/// Whether the window is where it was planned, and was come to as planned.
bool LocalPlanner::is_as_planned() const {
  for (int i = std::max(0, window_.executed() - 1); i <= window_.last(); ++i) {
    if (!plan_.is_as_planned(i)) return false;
  }
  return true;
}

bool LocalPlanner::wants_proposals() {
  if (proposals_.size() == 0 || is_good()) return false;
  const bool feasible = incumbent_.best().quality.feasible();
  return !proposals_.paused_at(window_.executed()) || !(left_over_ || feasible);
}

/// The solver's state, to what the phase is about.
bool LocalPlanner::offer() {
  const bool beside = phase_ == Phase::kFollowFallback || phase_ == Phase::kRaiseFallback;
  if (beside) return beside_.offer(solver_.quality(), solver_.state());
  const bool better = incumbent_.offer(solver_.quality(), solver_.state());
  better_ = better_ || better;
  return better;
}

/// Into the graph, where it has another one.
void LocalPlanner::hand_out_best() {
  if (!std::exchange(better_, false)) return;
  solver_.store(incumbent_.best().state);
  plan_.follow_moved(window_.first(), window_.last());
}

void LocalPlanner::describe_best(CycleReport& report) const {
  const WindowQuality& best = incumbent_.best().quality;
  report.feasible_steps = best.feasible_steps;
  // Only the next step has to hold now; later cycles can still mend the rest.
  report.next_feasible = best.feasible_steps >= 1;
  if (best.feasible()) {
    report.status = PlannerStatus::kSolved;
    report.reason = "feasible";
    return;
  }
  report.violated_at = report.executed + best.feasible_steps + 1;
}

void LocalPlanner::explain(CycleReport& last) const {
  if (last.success()) return;
  last.violation = solver_.describe(incumbent_.best().quality.first);
  const int slot = plan_.slot(last.violated_at);
  last.reason = violated_text(*last.violation, plan_.graph().vertex_record(slot).id);
  if (last.cut_short) last.reason += std::string("; ") + end_text(last.status);
}

}  // namespace locograph
