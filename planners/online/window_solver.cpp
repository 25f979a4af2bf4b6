#include <locograph/common/check_option.h>
#include <locograph/planners/online/window_solver.h>
#include <locograph/solvers/linear_solvers.h>

#include <algorithm>

namespace locograph {

/// Where the augmented Lagrangian has brought a row of a constraint.
struct WindowSolver::Multiplier {
  int edge, row;
  double shift, scale;
};

namespace {

/// Constraints weigh up to 1e5 times as much as tracking: λ must begin far below either.
constexpr double kLeastLambda = 1e-10;

OptimiserOptions optimiser_options(const WindowSolverOptions& options) {
  OptimiserOptions result;
  result.max_iterations = options.max_iterations;
  result.gain = options.gain;
  result.initial_lambda = kLeastLambda;
  return result;
}

bool cut_short(const OptimiserResult& result, const Termination& termination,
               const WindowStatistics& statistics) {
  return result.reason == OptimiserResult::Reason::kDeadline || termination.stopped() ||
         termination.used_up(statistics.iterations);
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
      incumbent_lambda_(kLeastLambda),
      candidate_lambda_(kLeastLambda) {}

WindowSolver::~WindowSolver() = default;

void WindowSolver::compile(const Window& window) {
  problem_.compile(window.graph(), window.free_vertices(), window.held_vertices());
  workspace_.allocate(problem_);
  workspace_.bind(window.plan().bindings());
  restore_multipliers();
  step_of_.clear();
  for (const CompiledConstraint& c : problem_.constraints()) {
    step_of_.push_back(window.step_of(c.edge));
  }
  steps_ = window.steps();
  first_iteration_ = true;
}

void WindowSolver::store_state(const std::vector<double>& state) {
  workspace_.state() = state;
  workspace_.store_state();
}

void WindowSolver::prepare() {
  optimiser_.start(workspace_, *linear_solver_);
  optimiser_.iterate();
}

/// To the rows of a workspace just allocated.
void WindowSolver::restore_multipliers() {
  std::vector<ConstraintRow>& rows = workspace_.constraint_rows();
  auto next = multipliers_.begin();
  for (const CompiledConstraint& c : problem_.constraints()) {
    while (next != multipliers_.end() && next->edge < c.edge) ++next;
    for (; next != multipliers_.end() && next->edge == c.edge; ++next) {
      rows[c.row + next->row].shift = next->shift;
      rows[c.row + next->row].scale = next->scale;
    }
  }
}

void WindowSolver::keep_multipliers() {
  multipliers_.clear();
  for (const CompiledConstraint& c : problem_.constraints()) {
    for (int r = 0; r < c.count; ++r) {
      const ConstraintRow& row = workspace_.constraint_rows()[c.row + r];
      if (row.shift != 0.0 || row.scale != 1.0) {
        multipliers_.push_back({c.edge, r, row.shift, row.scale});
      }
    }
  }
}

/// Of the state that was evaluated last.
WindowQuality WindowSolver::quality(double cost) const {
  return window_quality(reader_, step_of_, steps_, cost);
}

void WindowSolver::offer_state(Incumbent& incumbent) {
  incumbent.offer(quality(workspace_.evaluate(workspace_.state()).robust), workspace_.state());
}

/// The next run begins near where this one did: a step that was refused here would be refused
/// there.
void WindowSolver::learn(double& lambda) {
  constexpr double kChange = 10.0;
  const OptimiserResult& result = optimiser_.result();
  if (result.statistics.empty()) return;
  const IterationStatistics& first = result.statistics.front();
  diagonal_.resize(workspace_.step().size());
  workspace_.diagonal(diagonal_);
  const double unit = *std::max_element(diagonal_.begin(), diagonal_.end());
  if (result.iterations == 0 && result.reason == OptimiserResult::Reason::kDeadline) {
    lambda = std::max(kChange * lambda, optimiser_.options().refused_lambda);
  } else {
    lambda = std::max(kLeastLambda, first.refusals > 0 ? first.lambda / unit : lambda / kChange);
  }
}

/// By the last iteration. After one that took no step nobody knows yet how much there is to gain.
bool WindowSolver::gained_little() const {
  const OptimiserResult& result = optimiser_.result();
  const std::vector<IterationStatistics>& steps = result.statistics;
  if (result.iterations == 0 || steps.empty()) return false;
  const double before = steps.size() > 1 ? steps[steps.size() - 2].cost : result.initial.robust;
  return before - steps.back().cost <= options_.feasible_gain * before;
}

/// Whether the last iteration left a feasible window and gained little.
bool WindowSolver::good_enough() const {
  return gained_little() && quality(optimiser_.result().final.robust).feasible();
}

void WindowSolver::add_statistics(WindowStatistics& statistics) const {
  const OptimiserResult& result = optimiser_.result();
  statistics.iterations += result.iterations;
  for (const IterationStatistics& step : result.statistics) {
    statistics.linearise_s += step.time_linearise;
    statistics.solve_s += step.time_solve;
    statistics.evaluate_s += step.time_evaluate;
    statistics.iteration_s = std::max(statistics.iteration_s,
                                      step.time_linearise + step.time_solve + step.time_evaluate);
  }
}

WindowSolver::Run WindowSolver::optimise(Start start, Incumbent& incumbent,
                                         const Termination& termination,
                                         WindowStatistics& statistics) {
  Stopwatch watch;
  double& lambda = start == Start::kIncumbent ? incumbent_lambda_ : candidate_lambda_;
  optimiser_.options().initial_lambda = lambda;
  optimiser_.start(workspace_, *linear_solver_);
  const OptimiserResult& result = optimiser_.result();
  Run run;
  run.better = incumbent.offer(quality(result.initial.robust), workspace_.state());
  // However little time there is, a cycle makes one step, or tries to.
  constexpr double kOneStep_s = 1e-4;
  const Deadline& deadline = termination.deadline;
  optimiser_.options().max_iterations =
      termination.left_of(options_.max_iterations, statistics.iterations);
  optimiser_.options().deadline =
      first_iteration_ && deadline.passed() ? Deadline::after(kOneStep_s) : deadline;
  const bool more = optimiser_.iterate();
  first_iteration_ = false;
  optimiser_.options().deadline = deadline;
  while (more && !good_enough() && !termination.stopped() && optimiser_.iterate()) {
  }
  learn(lambda);
  add_statistics(statistics);
  run.cut_short = cut_short(result, termination, statistics);
  statistics.optimise_s += watch.lap();
  workspace_.return_to_state();
  run.better = incumbent.offer(quality(result.final.robust), workspace_.state()) || run.better;
  statistics.check_s += watch.lap();
  return run;
}

WindowSolver::Run WindowSolver::raise_constraints(Incumbent& incumbent,
                                                  const Termination& termination,
                                                  WindowStatistics& statistics) {
  const Stopwatch watch;
  ConstrainedOptions raising;
  raising.inner = optimiser_options(options_);
  raising.inner.deadline = termination.deadline;
  raising.inner.on_iteration = [&, made = statistics.iterations](const OptimiserResult&) mutable {
    return !termination.stopped() && !termination.used_up(++made);
  };
  raising.inner.shorten_steps = true;
  // The first two rounds find the violations that do not come down by themselves.
  raising.max_rounds = options_.max_rounds + 2;
  raising.own_tolerances = true;
  raising.tolerance = ViolationOptions().tolerance;
  raising.growth = options_.raise;
  raising.max_penalty = options_.max_raise;
  workspace_.state() = incumbent.least_violating().state;
  const ConstrainedResult result = optimise_constrained(workspace_, raising, *linear_solver_, true);
  statistics.iterations += result.iterations;
  statistics.rounds = result.rounds;
  Run run;
  run.cut_short = cut_short(result.inner, termination, statistics);
  run.better = incumbent.offer(quality(result.inner.final.robust), workspace_.state());
  keep_multipliers();
  statistics.optimise_s += watch.seconds();
  return run;
}

}  // namespace locograph
