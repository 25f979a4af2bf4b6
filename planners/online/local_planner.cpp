#include <locograph/common/check_option.h>
#include <locograph/planners/online/local_planner.h>
#include <locograph/planners/online/window_cause.h>

#include <algorithm>
#include <utility>

namespace locograph {
namespace {

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
  first.move_to(0);
  solver_.compile(first);
  solver_.load_state();
  solver_.prepare();
}

void LocalPlanner::show(std::shared_ptr<const WorldSnapshot> world) {
  world->distance();
  const std::lock_guard lock(showing_);
  shown_ = std::move(world);
}

/// Whether there was something new.
bool LocalPlanner::take_shown() {
  std::shared_ptr<const WorldSnapshot> world;
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

CycleReport LocalPlanner::cycle(int executed, const Termination& termination) {
  if (executed < 0 || executed + 1 >= plan_size()) {
    throw Error("executed configuration " + std::to_string(executed),
                "0 to " + std::to_string(plan_size() - 2));
  }
  termination.validate();
  CycleReport report;
  report.executed = executed;
  const Stopwatch watch;
  new_world_ = take_shown();
  if (settled_ && !new_world_ && answer_.executed == executed) {
    report = answer_;
    report.detour = report.deadline_missed = false;
    report.statistics = {};
    report.statistics.constraints = answer_.statistics.constraints;
    report.statistics.total_s = watch.seconds();
    return report;
  }
  begin(report);
  const bool cut_short = improve(report, termination);
  keep_unfinished(cut_short);
  hand_out_best();
  describe_best(report);
  const auto end = end_by(termination, report.statistics.iterations);
  if (cut_short && end && !report.success()) {
    report.status = end->status;
    report.reason += "; " + end->reason;
  }
  report.statistics.total_s = watch.seconds();
  report.deadline_missed = termination.deadline.passed();
  keep_answer(report, cut_short);
  return report;
}

void LocalPlanner::keep_answer(const CycleReport& report, bool cut_short) {
  const WindowQuality& quality = incumbent_.best().quality;
  const bool again = answer_.executed == report.executed && !new_world_;
  settled_ = again && !cut_short && !quality.feasible() && !quality.better_than(quality_);
  quality_ = quality;
  answer_ = report;
}

void LocalPlanner::begin(CycleReport& report) {
  const Stopwatch watch;
  incumbent_.clear();
  window_.move_to(report.executed);
  warm_start_.enter(window_);
  solver_.compile(window_);
  solver_.load_state();
  report.window = window_.steps();
  report.statistics.constraints = static_cast<int>(solver_.problem().constraints().size());
  report.statistics.compile_s = watch.seconds();
}

/// Optimises, asks proposals and raises constraints, as far as there is need and time. Returns
/// whether the termination cut the last of it short.
bool LocalPlanner::improve(CycleReport& report, const Termination& termination) {
  using Start = WindowSolver::Start;
  const WindowQuality& best = incumbent_.best().quality;
  const bool continued = load_unfinished();
  bool cut_short = false;
  if (!continued && !proposals_.due() && is_as_planned()) {
    solver_.offer_state(incumbent_);
    if (best.feasible()) return false;
  }
  if (proposals_.due()) {
    solver_.offer_state(incumbent_);
    cut_short = try_proposals(report, termination);
  } else {
    const Start start = continued ? Start::kCandidate : Start::kIncumbent;
    cut_short = solver_.optimise(start, incumbent_, termination, report.statistics).cut_short;
    // It may take some cycles more.
    if (cut_short && continued) proposals_.pause_after(report.executed);
    proposals_.set_due(cut_short && !continued && !best.feasible());
  }
  if (cut_short) return true;
  hand_out_best();
  const int& iterations = report.statistics.iterations;
  if (!report.detour && wants_proposals(continued) && !termination.ended(iterations)) {
    cut_short = try_proposals(report, termination);
  }
  if (!cut_short && !best.feasible() && options_.solver.max_rounds > 0 &&
      !termination.ended(iterations)) {
    cut_short = solver_.raise_constraints(incumbent_, termination, report.statistics).cut_short;
    proposals_.pause_after(report.executed);
  }
  if (!cut_short && !best.feasible() && !termination.ended(iterations)) {
    cut_short = try_fallbacks(report, termination);
  }
  return cut_short;
}

/// The window that the last cycle left unfinished, in the place of the one that it handed out,
/// which is offered as it is. Returns whether there is one.
bool LocalPlanner::load_unfinished() {
  if (!warm_start_.has_unfinished()) return false;
  solver_.offer_state(incumbent_);
  warm_start_.load_unfinished(window_);
  solver_.load_state();
  return true;
}

/// Whether the window is where it was planned, and was come to as planned. Not on wheels, where a
/// window has an end that is free.
bool LocalPlanner::is_as_planned() const {
  if (plan_.rolls(window_.last())) return false;
  for (int i = std::max(0, window_.executed() - 1); i <= window_.last(); ++i) {
    if (!plan_.is_as_planned(i)) return false;
  }
  return true;
}

/// continued: the cycle began with an unfinished window.
bool LocalPlanner::wants_proposals(bool continued) const {
  const bool feasible = incumbent_.best().quality.feasible();
  if (feasible && !(plan_.behind_m(window_.last()) > options_.blocked_m)) return false;
  return !proposals_.paused_at(window_.executed()) || !(continued || feasible);
}

/// Asks each of the proposals, and optimises from their candidates. Returns whether the
/// termination cut one of them short.
bool LocalPlanner::try_proposals(CycleReport& report, const Termination& termination) {
  bool better = false;
  for (int asked = 0; asked < proposals_.size(); ++asked) {
    const Proposal::Answer answer = ask(proposals_, report, termination);
    if (answer == Proposal::Answer::kUnfinished) return true;
    if (answer == Proposal::Answer::kNone) continue;
    const WindowSolver::Run run = solver_.optimise(WindowSolver::Start::kCandidate, incumbent_,
                                                   termination, report.statistics);
    if (run.cut_short) {
      proposals_.pause_after(report.executed);
      return true;
    }
    better = run.better || better;
  }
  if (!better) proposals_.pause_after(report.executed);
  return false;
}

/// One after the other, until a window is feasible. Returns whether the termination cut one of them
/// short.
bool LocalPlanner::try_fallbacks(CycleReport& report, const Termination& termination) {
  for (int asked = 0; asked < fallbacks_.size(); ++asked) {
    const Proposal::Answer answer = ask(fallbacks_, report, termination);
    if (answer == Proposal::Answer::kUnfinished) return true;
    if (answer == Proposal::Answer::kNone) continue;
    beside_.clear();
    WindowSolver::Run run =
        solver_.optimise(WindowSolver::Start::kCandidate, beside_, termination, report.statistics);
    if (!run.cut_short && !beside_.best().quality.feasible() && options_.solver.max_rounds > 0) {
      run = solver_.raise_constraints(beside_, termination, report.statistics);
    }
    incumbent_.offer(beside_.best().quality, beside_.best().state);
    if (run.cut_short) return true;
    if (incumbent_.best().quality.feasible()) break;
  }
  return false;
}

/// Loads the candidate that one of them finds into the solver.
Proposal::Answer LocalPlanner::ask(ProposalSchedule& proposals, CycleReport& report,
                                   const Termination& termination) {
  report.detour = true;
  const Stopwatch watch;
  const Proposal::Answer answer = proposals.ask(plan_, window_, termination, candidate_);
  if (answer == Proposal::Answer::kFound) plan_.overwrite(window_.first(), candidate_);
  solver_.load_state();
  report.statistics.proposals_s += watch.seconds();
  return answer;
}

void LocalPlanner::keep_unfinished(bool cut_short) {
  warm_start_.drop_unfinished();
  const std::vector<double>* state = incumbent_.unfinished(cut_short ? &solver_.state() : nullptr);
  if (state == nullptr) return;
  solver_.store_state(*state);
  warm_start_.keep_unfinished(window_);
}

/// Into the graph.
void LocalPlanner::hand_out_best() {
  solver_.store_state(incumbent_.best().state);
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
  report.violation = solver_.describe(best.first);
  report.violated_at = report.executed + best.feasible_steps + 1;
  const int slot = plan_.slot(report.violated_at);
  report.reason = violated_text(*report.violation, plan_.graph().vertex_record(slot).id);
}

}  // namespace locograph
