#include <locograph/planners/offline/drive/wheel_motion.h>
#include <locograph/planners/online/local_planner.h>
#include <locograph/solvers/linear_solvers.h>

#include <algorithm>

namespace locograph {

/// Where the augmented Lagrangian has brought a row of a constraint.
struct LocalPlanner::Multiplier {
  int edge, row;
  double shift, scale;
};

namespace {

/// Constraints weigh up to 1e5 times as much as tracking: λ must begin far below either.
constexpr double kLeastLambda = 1e-10;

OptimiserOptions optimiser_options(const LocalPlannerOptions& options) {
  OptimiserOptions result;
  result.max_iterations = options.max_iterations;
  result.gain = options.gain;
  result.initial_lambda = kLeastLambda;
  return result;
}

void add_once(std::vector<int>& slots, int slot) {
  if (std::find(slots.begin(), slots.end(), slot) == slots.end()) slots.push_back(slot);
}

}  // namespace

void LocalPlannerOptions::validate() const {
  if (horizon < 1) throw Error("horizon " + std::to_string(horizon), "1 or more");
  if (!(deadline_s >= 0.0)) throw Error("the deadline is negative", "0 (none) or more");
  if (max_iterations < 1) throw Error("max_iterations is less than 1", "1 or more");
  if (max_rounds < 0) throw Error("max_rounds is negative", "0 or more");
  if (detour_pause < 0) throw Error("detour_pause is negative", "0 or more");
  if (!(raise > 1.0)) throw Error("penalties are not raised", "a factor > 1");
  if (!(max_raise >= 1.0)) throw Error("max_raise is less than 1", "a factor of 1 or more");
}

LocalPlanner::LocalPlanner(Graph& graph, const LocalPlannerOptions& options)
    : graph_(graph),
      options_(options),
      plan_(plan_of(graph)),
      reader_(workspace_),
      solver_(make_linear_solver("auto")),
      optimiser_(optimiser_options(options)),
      lambda_(kLeastLambda),
      lambda_aside_(kLeastLambda),
      detour_(plan_.robot, options.detour) {
  options.validate();
  for (const auto& stance : plan_.stance_from) {
    if (!stance || stance->wheels.empty()) {
      throw Error("a configuration of the plan stands on no wheels", "a stance with wheels");
    }
  }
  if (!plan_.world) throw Error("the plan has no world", "a PARAMS_WORLD line");
  for (int i = 0; i < plan_size(); ++i) planned_.emplace_back(configuration(i));
  unfinished_.resize(planned_.size());
  // Memory, the lists of edges and the order of elimination now rather than in the first cycle.
  CycleReport first;
  first.window = std::min(options_.horizon, plan_size() - 1);
  if (first.window < 1) return;
  compile(first);
  workspace_.load_state();
  optimiser_.start(workspace_, *solver_);
  optimiser_.iterate();
}

LocalPlanner::~LocalPlanner() = default;

Eigen::Map<Eigen::VectorXd> LocalPlanner::configuration(int index) {
  const int slot = plan_.slots[index];
  return {graph_.state(slot), graph_.state_size(slot)};
}

Eigen::Map<const Eigen::VectorXd> LocalPlanner::configuration(int index) const {
  const int slot = plan_.slots[index];
  return {std::as_const(graph_).state(slot), graph_.state_size(slot)};
}

void LocalPlanner::show(const WorldDistance& world) {
  plan_.world->now = world;
  detour_.forget();
}

/// A configuration that goes on from the two before it: as the plan does, and away from it as they
/// do, wheels rolling. Steered wheels cannot return to the plan at once.
Eigen::VectorXd LocalPlanner::go_on(int i, const Eigen::VectorXd& last,
                                    const Eigen::VectorXd* before_last) const {
  const Robot& robot = *plan_.robot->robot;
  Eigen::VectorXd step(robot.tangent_size()), planned(robot.tangent_size());
  robot.difference(planned_[i - 1].data(), planned_[i].data(), step.data());
  if (before_last != nullptr) {
    Eigen::VectorXd made(robot.tangent_size());
    robot.difference(planned_[i - 2].data(), planned_[i - 1].data(), planned.data());
    robot.difference(before_last->data(), last.data(), made.data());
    for (const int along_the_ground : {0, 1, 5}) {
      step[along_the_ground] += made[along_the_ground] - planned[along_the_ground];
    }
  }
  Eigen::VectorXd q(last.size());
  robot.integrate(last.data(), step.data(), q.data());
  WheelMotion(robot, plan_.stance_from[static_cast<std::size_t>(i) - 1]->stance).roll(last, q);
  return q;
}

void LocalPlanner::enter(int executed, int last) {
  for (int i = std::max(entered_, executed) + 1; i <= last; ++i) {
    if (is_fixed(i)) continue;
    const Eigen::VectorXd before = configuration(i - 1);
    const Eigen::VectorXd before_that = configuration(std::max(0, i - 2));
    configuration(i) = go_on(i, before, i > 1 ? &before_that : nullptr);
  }
  entered_ = std::max(entered_, last);
  if (unfinished_end_ <= executed + 1) unfinished_end_ = 0;
  for (; unfinished_end_ > 0 && unfinished_end_ <= last; ++unfinished_end_) {
    const int i = unfinished_end_;
    const Eigen::VectorXd before_that =
        i - 2 > executed ? unfinished_[i - 2] : configuration(std::max(0, i - 2));
    unfinished_[i] =
        is_fixed(i) ? planned_[i] : go_on(i, unfinished_[i - 1], i > 1 ? &before_that : nullptr);
  }
}

/// The configurations of the window, and vertices of other types whose configurations all lie in
/// it: these are free. What was executed and is tied to them, and what they share with
/// configurations elsewhere: held.
void LocalPlanner::gather_window(int executed, int last) {
  window_.assign(plan_.slots.begin() + executed + 1, plan_.slots.begin() + last + 1);
  held_.assign(1, plan_.slots[executed]);
  const auto in_window = [&](int index) { return index > executed && index <= last; };
  const auto belongs = [&](int slot) {
    for (const int e : graph_.incident_edges(slot)) {
      for (const int v : graph_.edge_vertices(e)) {
        if (plan_.index.configuration[v] >= 0 && !in_window(plan_.index.configuration[v]))
          return false;
      }
    }
    return true;
  };
  for (int i = executed + 1; i <= last; ++i) {
    for (const int e : graph_.incident_edges(plan_.slots[i])) {
      for (const int v : graph_.edge_vertices(e)) {
        const int index = plan_.index.configuration[v];
        if (in_window(index) || index > last) continue;
        if (index < 0 && belongs(v)) {
          add_once(window_, v);
        } else {
          add_once(held_, v);
        }
      }
    }
  }
}

/// Index of a configuration; of another vertex, that of the first configuration it shares an edge
/// with.
int LocalPlanner::configuration_of(int slot) const {
  if (plan_.index.configuration[slot] >= 0) return plan_.index.configuration[slot];
  int first = plan_size();
  for (const int e : graph_.incident_edges(slot)) {
    for (const int v : graph_.edge_vertices(e)) {
      if (plan_.index.configuration[v] >= 0) first = std::min(first, plan_.index.configuration[v]);
    }
  }
  return first < plan_size() ? first : -1;
}

void LocalPlanner::compile(CycleReport& report) {
  const int last = report.executed + report.window;
  gather_window(report.executed, last);
  problem_.compile(graph_, window_, held_);
  workspace_.allocate(problem_);
  restore_multipliers();
  step_of_.clear();
  for (const CompiledConstraint& c : problem_.constraints()) {
    int step = 1;
    for (const int v : graph_.edge_vertices(c.edge)) {
      step = std::max(step, configuration_of(v) - report.executed);
    }
    step_of_.push_back(std::min(step, report.window));
  }
  steps_ = report.window;
  report.constraints = static_cast<int>(problem_.constraints().size());
}

/// To the rows of a workspace just allocated.
void LocalPlanner::restore_multipliers() {
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

void LocalPlanner::keep_multipliers() {
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

WindowQuality LocalPlanner::read(double cost) const {
  return window_quality(reader_, step_of_, steps_, cost);
}

/// Of the state that was evaluated last. Whether it is the best window so far.
bool LocalPlanner::take_if_better(const WindowQuality& quality) {
  if (nearest_state_.empty() || quality.worst.ratio < nearest_.worst.ratio) {
    nearest_ = quality;
    nearest_state_ = workspace_.state();
  }
  if (!best_state_.empty() && !quality.better_than(best_)) return false;
  best_ = quality;
  best_state_ = workspace_.state();
  return true;
}

/// The best window so far, into the graph.
/// Slopes are those of the plan as it came: what has moved goes by the rule of the curve.
void LocalPlanner::store_best() {
  workspace_.state() = best_state_;
  workspace_.store_state();
  for (const int slot : window_) {
    const int i = plan_.index.configuration[static_cast<std::size_t>(slot)];
    if (i < 0 || configuration(i) == planned_[static_cast<std::size_t>(i)]) continue;
    graph_.vertex(VertexId<VertexConfiguration>{slot}).slopes.resize(0);
  }
}

/// A cycle goes on near where the last one was: a step that was refused there will be here.
void LocalPlanner::learn_lambda(double& lambda) {
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

/// The last iteration; one that took no step gained much: nobody knows yet.
bool LocalPlanner::gained_little() const {
  const OptimiserResult& result = optimiser_.result();
  const std::vector<IterationStatistics>& steps = result.statistics;
  if (result.iterations == 0 || steps.empty()) return false;
  const double before = steps.size() > 1 ? steps[steps.size() - 2].cost : result.initial.robust;
  return before - steps.back().cost <= options_.feasible_gain * before;
}

/// Whether the last iteration left a feasible window and gained little.
bool LocalPlanner::good_enough() const {
  return gained_little() && read(optimiser_.result().final.robust).feasible();
}

/// From the state of the workspace; whether it ends in a better window than the best one so far.
/// The state it begins with counts as well.
bool LocalPlanner::optimise(CycleReport& report, const Deadline& deadline, double& lambda) {
  Stopwatch watch;
  optimiser_.options().initial_lambda = lambda;
  optimiser_.start(workspace_, *solver_);
  bool better = take_if_better(read(optimiser_.result().initial.robust));
  // However little time there is, a cycle makes one step, or tries to.
  constexpr double kOneStep_s = 1e-4;
  optimiser_.options().deadline =
      first_iteration_ && deadline.passed() ? Deadline::after(kOneStep_s) : deadline;
  const bool more = optimiser_.iterate();
  first_iteration_ = false;
  optimiser_.options().deadline = deadline;
  while (more && !good_enough() && optimiser_.iterate()) {
  }
  const OptimiserResult& result = optimiser_.result();
  learn_lambda(lambda);
  cut_short_ = result.reason == OptimiserResult::Reason::kDeadline;
  report.iterations += result.iterations;
  for (const IterationStatistics& step : result.statistics) {
    report.time_linearise += step.time_linearise;
    report.time_solve += step.time_solve;
    report.time_evaluate += step.time_evaluate;
    report.time_iteration =
        std::max(report.time_iteration, step.time_linearise + step.time_solve + step.time_evaluate);
  }
  report.time_optimise += watch.lap();
  workspace_.return_to_state();
  better = take_if_better(read(result.final.robust)) || better;
  report.time_check += watch.lap();
  return better;
}

double LocalPlanner::behind_m(int index) const {
  const Eigen::Vector3d behind = planned_[index].head<3>() - configuration(index).head<3>();
  const Eigen::Vector3d left = DetourSearch::left(planned_[index].data());
  return behind.dot(left.cross(Eigen::Vector3d::UnitZ()));
}

/// The window as planned, moved sideways; wheels steered along the way and turned to match. False
/// when there is no time for it.
bool LocalPlanner::apply_detour(const CycleReport& report, const Deadline& deadline) {
  const int executed = report.executed, last = executed + report.window;
  const Robot& robot = *plan_.robot->robot;
  std::vector<const double*> plan;
  std::vector<double> times;
  for (int i = executed + 1; i <= last; ++i) {
    plan.push_back(planned_[i].data());
    times.push_back(graph_.vertex(VertexId<VertexConfiguration>{plan_.slots[i]}).time_s);
  }
  const auto offset_of = [&](int i) {
    return (configuration(i).head<3>() - planned_[i].head<3>())
        .dot(DetourSearch::left(planned_[i].data()));
  };
  const double start = offset_of(executed);
  const double slope = executed > 0 ? start - offset_of(executed - 1) : 0.0;
  const std::vector<double> offsets =
      detour_.find(executed + 1, plan, times, plan_.world->now, start, slope, deadline);
  if (offsets.empty()) return false;

  for (int i = executed + 1; i <= last; ++i) {
    if (is_fixed(i)) continue;
    Eigen::Map<Eigen::VectorXd> q = configuration(i);
    q = planned_[i];
    q.head<3>() += offsets[i - executed - 1] * DetourSearch::left(planned_[i].data());
  }
  WheelMotion wheels(robot, plan_.stance_from[static_cast<std::size_t>(executed)]->stance);
  Eigen::VectorXd before = configuration(executed);
  for (int i = executed + 1; i <= last; ++i) {
    Eigen::VectorXd q = configuration(i);
    const Eigen::VectorXd after = configuration(std::min(i + 1, last));
    const Eigen::Vector3d way = (after - before).head<3>();
    if (way.norm() > 1e-3) {
      for (int w = 0; w < wheels.wheels(); ++w) wheels.steer(q, w, way);
    }
    wheels.roll(before, q);
    if (!is_fixed(i)) configuration(i) = q;
    before = configuration(i);
  }
  return true;
}

void LocalPlanner::search_detour(CycleReport& report, const Deadline& deadline) {
  report.detour = true;
  const Stopwatch watch;
  const bool found = apply_detour(report, deadline);
  workspace_.load_state();
  report.time_detour = watch.seconds();
  detour_due_ = !found && deadline.passed();
  if (detour_due_) {
    cut_short_ = true;
    return;
  }
  if (!found || !optimise(report, deadline, lambda_aside_) || cut_short_) wait_with_detours(report);
}

void LocalPlanner::wait_with_detours(const CycleReport& report) {
  detour_not_before_ = report.executed + 1 + options_.detour_pause;
}

/// Goes on from the window that violates least, however early, with what it violates raised.
void LocalPlanner::raise_constraints(CycleReport& report, const Deadline& deadline) {
  const Stopwatch watch;
  ConstrainedOptions raising;
  raising.inner = optimiser_options(options_);
  raising.inner.deadline = deadline;
  raising.inner.shorten_steps = true;
  // The first two find out what does not come down by itself.
  raising.max_rounds = options_.max_rounds + 2;
  raising.own_tolerances = true;
  raising.tolerance = ViolationOptions().tolerance;
  raising.growth = options_.raise;
  raising.max_penalty = options_.max_raise;
  workspace_.state() = nearest_state_;
  const ConstrainedResult result = optimise_constrained(workspace_, raising, *solver_, true);
  cut_short_ = result.inner.reason == OptimiserResult::Reason::kDeadline;
  report.iterations += result.iterations;
  report.rounds = result.rounds;
  take_if_better(read(result.inner.final.robust));
  keep_multipliers();
  report.time_optimise += watch.seconds();
}

/// What the last cycle could not finish: from there, rather than from what it handed out.
void LocalPlanner::load_unfinished(const CycleReport& report) {
  if (unfinished_end_ == 0) return;
  take_if_better(read(workspace_.evaluate(workspace_.state()).robust));
  for (int i = report.executed + 1; i <= report.executed + report.window; ++i) {
    if (!is_fixed(i)) configuration(i) = unfinished_[i];
  }
  workspace_.load_state();
}

void LocalPlanner::keep_unfinished(const CycleReport& report) {
  unfinished_end_ = 0;
  if (!cut_short_) {
    if (best_.feasible()) return;
    workspace_.state() = nearest_state_;
  }
  if (workspace_.state() == best_state_) return;
  workspace_.store_state();
  unfinished_end_ = report.executed + report.window + 1;
  for (int i = report.executed + 1; i < unfinished_end_; ++i) unfinished_[i] = configuration(i);
}

CycleReport LocalPlanner::cycle(int executed) {
  if (executed < 0 || executed + 1 >= plan_size()) {
    throw Error("executed configuration " + std::to_string(executed),
                "0 to " + std::to_string(plan_size() - 2));
  }
  CycleReport report;
  report.executed = executed;
  const Stopwatch cycle_watch;
  const Deadline deadline =
      options_.deadline_s > 0.0 ? Deadline::after(options_.deadline_s) : Deadline();
  const int last = std::min(executed + options_.horizon, plan_size() - 1);
  report.window = last - executed;
  best_state_.clear();
  nearest_state_.clear();
  first_iteration_ = true;

  const Stopwatch watch;
  enter(executed, last);
  compile(report);
  workspace_.load_state();
  report.time_compile = watch.seconds();

  const bool goes_on = unfinished_end_ > 0;
  load_unfinished(report);
  if (detour_due_) {
    cut_short_ = false;
    take_if_better(read(workspace_.evaluate(workspace_.state()).robust));
    search_detour(report, deadline);
  } else {
    optimise(report, deadline, goes_on ? lambda_aside_ : lambda_);
    if (cut_short_ && goes_on) wait_with_detours(report);  // it may take some cycles more
    detour_due_ = cut_short_ && !goes_on && !best_.feasible();
  }
  if (!cut_short_) {
    store_best();
    const bool wanted = !best_.feasible() || behind_m(last) > options_.blocked_m;
    const bool waits = executed < detour_not_before_ && (goes_on || best_.feasible());
    if (!report.detour && wanted && !waits && !deadline.passed()) search_detour(report, deadline);
    if (!cut_short_ && !best_.feasible() && options_.max_rounds > 0 && !deadline.passed()) {
      raise_constraints(report, deadline);
      wait_with_detours(report);
    }
  }
  keep_unfinished(report);
  store_best();
  report.feasible = best_.feasible();
  report.feasible_steps = best_.feasible_steps;
  // Only what comes next has to hold now; the rest has time to be mended.
  report.next_feasible = best_.feasible_steps >= 1;
  if (!report.feasible) {
    report.violation = reader_.describe(best_.first);
    report.violated_at = executed + best_.feasible_steps + 1;
  }
  report.time_total = cycle_watch.seconds();
  report.deadline_missed = options_.deadline_s > 0.0 && report.time_total > options_.deadline_s;
  return report;
}

}  // namespace locograph
