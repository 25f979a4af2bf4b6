#include <locograph/common/check_option.h>
#include <locograph/planners/online/window_solver.h>
#include <locograph/solvers/linear_solvers.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace locograph {

/// Where the augmented Lagrangian has brought a row of a constraint.
struct WindowSolver::Multiplier {
  int edge, row;
  double shift, scale;
  double last_violation;  ///< see ConstrainedOptimiser; while constraints are raised
};

namespace {

/// Constraints weigh up to 1e5 times as much as tracking: λ must begin far below either.
constexpr double kLeastLambda = 1e-10;
/// Of iterations in a row.
constexpr int kMostRefused = 8;

OptimiserOptions optimiser_options(const WindowSolverOptions& options) {
  OptimiserOptions result;
  result.max_iterations = options.max_iterations;
  result.gain = options.gain;
  result.initial_lambda = kLeastLambda;
  return result;
}

ConstrainedOptions raising_options(const WindowSolverOptions& options) {
  ConstrainedOptions raising;
  raising.inner = optimiser_options(options);
  raising.inner.shorten_steps = true;
  // The first two rounds find the violations that do not come down by themselves.
  raising.max_rounds = options.max_rounds + 2;
  raising.own_tolerances = true;
  raising.tolerance = ViolationOptions().tolerance;
  raising.growth = options.raise;
  raising.max_penalty = options.max_raise;
  return raising;
}

/// A step is made however late it is.
Deadline deadline_of_step(const Termination& termination) {
  return termination.deadline.passed() ? Deadline() : termination.deadline;
}

void add_times(const IterationStatistics& made, WindowStatistics& statistics) {
  statistics.linearise_s += made.time_linearise;
  statistics.solve_s += made.time_solve;
  statistics.evaluate_s += made.time_evaluate;
  statistics.iteration_s =
      std::max(statistics.iteration_s, made.time_linearise + made.time_solve + made.time_evaluate);
}

}  // namespace

void WindowSolverOptions::validate() const {
  check_option(max_iterations >= 1, "max_iterations", "1 or more");
  check_option(max_rounds >= 0, "max_rounds", "0 or more");
  check_option(raise > 1.0, "raise", "a factor > 1");
  check_option(max_raise >= 1.0, "max_raise", "a factor of 1 or more");
}

WindowSolver::WindowSolver(const WindowSolverOptions& options)
    : options_(options),
      reader_(workspace_),
      linear_solver_(make_linear_solver("auto")),
      optimiser_(optimiser_options(options)),
      raising_(raising_options(options)),
      incumbent_lambda_(kLeastLambda),
      candidate_lambda_(kLeastLambda) {}

WindowSolver::~WindowSolver() = default;

void WindowSolver::compile(const Window& window, bool slid) {
  quality_known_ = false;
  goes_on_ = run_ == RunKind::kRaising && !begins_;
  if (raised_) keep_multipliers();
  end_run();
  raised_ = false;
  if (slid) workspace_.keep();
  problem_.compile(window.graph(), window.free_vertices(), window.held_vertices());
  workspace_.allocate(problem_);
  workspace_.bind(window.plan().bindings());
  restore_multipliers();
  multipliers_.reserve(static_cast<std::size_t>(problem_.constraint_rows()));
  step_of_.clear();
  for (const CompiledConstraint& c : problem_.constraints()) {
    step_of_.push_back(window.step_of(c.edge));
  }
  steps_ = window.steps();
}

void WindowSolver::rebind(const Bindings& bindings) {
  quality_known_ = false;
  workspace_.bind(bindings);
  rebound_ = running();
}

void WindowSolver::load_state() {
  end_run();
  quality_known_ = false;
  workspace_.load_state();
}

void WindowSolver::set_state(const std::vector<double>& state) {
  if (state == workspace_.state()) return;
  end_run();
  quality_known_ = false;
  workspace_.set_state(state);
}

void WindowSolver::prepare() {
  quality_known_ = false;
  raising_.start(workspace_, *linear_solver_, true);
  optimiser_.start(workspace_, *linear_solver_);
  optimiser_.iterate();
}

/// Calls with the rows that were kept: with a row of the problem, and what it had.
template <class Take>
void WindowSolver::each_kept(const Take& take) const {
  auto next = multipliers_.begin();
  for (const CompiledConstraint& c : problem_.constraints()) {
    while (next != multipliers_.end() && next->edge < c.edge) ++next;
    for (; next != multipliers_.end() && next->edge == c.edge; ++next) {
      take(static_cast<std::size_t>(c.row + next->row), *next);
    }
  }
}

/// To the rows of a workspace just allocated.
void WindowSolver::restore_multipliers() {
  if (multipliers_.empty()) return;
  std::vector<ConstraintRow>& rows = workspace_.constraint_rows();
  each_kept([&](std::size_t row, const Multiplier& kept) {
    rows[row].shift = kept.shift;
    rows[row].scale = kept.scale;
  });
}

void WindowSolver::keep_multipliers() {
  multipliers_.clear();
  const std::vector<ConstraintRow>& rows = std::as_const(workspace_).constraint_rows();
  for (const CompiledConstraint& c : problem_.constraints()) {
    for (int r = 0; r < c.count; ++r) {
      const ConstraintRow& row = rows[c.row + r];
      // Before the first round ends nothing is known of any row: it is infinite.
      const double last = goes_on_ ? raising_.last_violations()[c.row + r] : 0.0;
      if (row.shift != 0.0 || row.scale != 1.0 || (last > 0.0 && std::isfinite(last))) {
        multipliers_.push_back({c.edge, r, row.shift, row.scale, last});
      }
    }
  }
}

WindowQuality WindowSolver::quality() {
  if (quality_known_) return quality_;
  const double cost = workspace_.return_to_state().robust;
  quality_ = window_quality(reader_, step_of_, steps_, cost);
  quality_known_ = true;
  return quality_;
}

WindowQuality WindowSolver::quality_of(const std::vector<double>& state) {
  if (state == workspace_.state()) return quality();
  return window_quality(reader_, step_of_, steps_, workspace_.evaluate(state).robust);
}

void WindowSolver::begin(Start start) {
  run_ = RunKind::kPlain;
  start_ = start;
  begins_ = true;
  refused_ = 0;
  gain_ = 1.0;
}

void WindowSolver::begin_raising() {
  begin(Start::kCandidate);
  run_ = RunKind::kRaising;
  raised_ = true;
}

void WindowSolver::end_run() {
  if (run_ == RunKind::kPlain && !begins_) learn();
  run_ = RunKind::kNone;
  begins_ = rebound_ = false;
}

void WindowSolver::begin_run() {
  begins_ = rebound_ = false;
  if (run_ == RunKind::kRaising) {
    if (!std::exchange(goes_on_, false)) {
      raising_.start(workspace_, *linear_solver_, true, true);
      return;
    }
    raising_.go_on(workspace_, *linear_solver_, true);
    std::vector<double>& last = raising_.last_violations();
    each_kept([&](std::size_t row, const Multiplier& kept) { last[row] = kept.last_violation; });
    return;
  }
  goes_on_ = false;
  optimiser_.options().initial_lambda = lambda();
  optimiser_.start(workspace_, *linear_solver_, true);
}

/// The next run begins near where this one did, or goes on from where it is: a step that was
/// refused here would be refused there.
void WindowSolver::learn() {
  constexpr double kChange = 10.0;
  const std::vector<IterationStatistics>& done = optimiser_.result().statistics;
  if (done.empty()) return;
  diagonal_.resize(workspace_.step().size());
  workspace_.diagonal(diagonal_);
  const double unit = *std::max_element(diagonal_.begin(), diagonal_.end());
  const auto taken = std::ranges::find_if(
      done, [](const IterationStatistics& one) { return one.step_norm > 0.0; });
  if (taken == done.end()) {
    lambda() = std::max(kChange * done.back().lambda / unit, optimiser_.options().refused_lambda);
    return;
  }
  const bool refused = taken != done.begin() || taken->refusals > 0;
  lambda() = std::max(kLeastLambda, refused ? taken->lambda / unit : lambda() / kChange);
}

bool WindowSolver::gained_little() const { return gain_ <= options_.feasible_gain; }

/// One that has to be short tries one step, or two where nothing has to be linearised; the next one
/// goes on where none was taken.
bool WindowSolver::step_plain(const Termination& termination) {
  using Reason = OptimiserResult::Reason;
  const bool is_short = termination.max_iterations > 0;
  OptimiserOptions& options = optimiser_.options();
  const int few = optimiser_.is_linearised() ? 2 : 1;
  options.max_refusals = is_short ? few : OptimiserOptions().max_refusals;
  options.deadline = deadline_of_step(termination);
  const int before = optimiser_.result().iterations;
  const bool more = optimiser_.iterate();
  const OptimiserResult& now = optimiser_.result();
  if (more || now.iterations > before) {
    refused_ = 0;
    return more;
  }
  const bool refused = now.reason == Reason::kDeadline || now.reason == Reason::kSingular ||
                       (is_short && now.reason == Reason::kNoProgress);
  if (!refused || ++refused_ >= kMostRefused) return false;
  optimiser_.go_on_refused();
  return true;
}

/// One that has to be short cuts a refused step less often.
bool WindowSolver::step_raising(const Termination& termination, WindowStatistics& statistics) {
  constexpr int kFewCuts = 6;
  const bool is_short = termination.max_iterations > 0;
  raising_.inner_options().max_cuts = is_short ? kFewCuts : OptimiserOptions().max_cuts;
  raising_.inner_options().deadline = deadline_of_step(termination);
  const bool more = raising_.iterate();
  statistics.rounds = raising_.rounds();
  return more;
}

bool WindowSolver::step(const Termination& termination, WindowStatistics& statistics) {
  const Stopwatch watch;
  const bool raises = run_ == RunKind::kRaising;
  if (begins_) {
    begin_run();
  } else if (std::exchange(rebound_, false)) {
    raises ? raising_.costs_changed() : optimiser_.costs_changed();
  }
  const auto accepted = [&] {
    return raises ? raising_.iterations() : optimiser_.result().iterations;
  };
  // Those of a plain run that were refused count, too.
  const auto tried = [&] {
    return raises ? accepted() : static_cast<int>(optimiser_.result().statistics.size());
  };
  const double before = (raises ? raising_.inner() : optimiser_.result()).final.robust;
  const int accepted_before = accepted(), tried_before = tried();
  const bool more = raises ? step_raising(termination, statistics) : step_plain(termination);
  const OptimiserResult& now = raises ? raising_.inner() : optimiser_.result();
  // Raising changes rows where it takes no step, too.
  quality_known_ = quality_known_ && !raises && accepted() == accepted_before;
  gain_ = accepted() == accepted_before ? 1.0 : (before - now.final.robust) / before;
  statistics.iterations += tried() - tried_before;
  if (!now.statistics.empty()) add_times(now.statistics.back(), statistics);
  if (!more) end_run();
  statistics.optimise_s += watch.seconds();
  return more;
}

}  // namespace locograph
