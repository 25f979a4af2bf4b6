#include <locograph/planners/offline/drive/wheel_motion.h>
#include <locograph/planners/online/local_planner.h>
#include <locograph/solvers/linear_solvers.h>

#include <algorithm>

namespace locograph {

struct LocalPlanner::RaisedWeight {
  EdgePool* pool;
  int index;
  Eigen::MatrixXd information;  ///< before
};

namespace {

OptimiserOptions optimiser_options(const LocalPlannerOptions& options) {
  OptimiserOptions result;
  result.max_iterations = options.max_iterations;
  result.gain = options.gain;
  // Constraints weigh up to 1e5 times as much as tracking: λ must begin far below either.
  result.initial_lambda = 1e-10;
  return result;
}

}  // namespace

void LocalPlannerOptions::validate() const {
  if (horizon < 1) throw Error("horizon " + std::to_string(horizon), "1 or more");
  if (!(deadline_s >= 0.0)) throw Error("the deadline is negative", "0 (none) or more");
  if (max_iterations < 1) throw Error("max_iterations is less than 1", "1 or more");
  if (max_rounds < 0) throw Error("max_rounds is negative", "0 or more");
  if (detour_pause < 0) throw Error("detour_pause is negative", "0 or more");
  if (!(raise > 1.0)) throw Error("weights are not raised", "a factor > 1");
}

LocalPlanner::LocalPlanner(Graph& graph, const LocalPlannerOptions& options)
    : graph_(graph),
      options_(options),
      plan_(plan_of(graph)),
      solver_(make_linear_solver("auto")),
      optimiser_(optimiser_options(options)),
      detour_(plan_.robot, options.detour) {
  options.validate();
  for (const auto& stance : plan_.stance_from) {
    if (!stance || stance->wheels.empty()) {
      throw Error("a configuration of the plan stands on no wheels", "a stance with wheels");
    }
  }
  if (!plan_.world) throw Error("the plan has no world", "a PARAMS_WORLD line");
  for (int i = 0; i < plan_size(); ++i) planned_.emplace_back(configuration(i));
  // Builds the lists of edges of all vertices now rather than in the first cycle.
  graph_.incident_edges(plan_.slots.front());
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

void LocalPlanner::show(const WorldDistance& world) { plan_.world->now = world; }

/// Configurations new to the window: as planned, moved along with the one before them.
void LocalPlanner::enter(int executed, int last) {
  const int base = plan_.robot->robot->base_configuration_size();
  for (int i = std::max(entered_, executed) + 1; i <= last; ++i) {
    const Eigen::VectorXd before = configuration(i - 1);
    Eigen::Map<Eigen::VectorXd> q = configuration(i);
    q.head<3>() += before.head<3>() - planned_[i - 1].head<3>();
    q.tail(q.size() - base) += before.tail(q.size() - base) - planned_[i - 1].tail(q.size() - base);
  }
  entered_ = std::max(entered_, last);
}

void LocalPlanner::compile(int executed, int last) {
  window_.assign(plan_.slots.begin() + executed + 1, plan_.slots.begin() + last + 1);
  held_.assign(1, plan_.slots[executed]);
  problem_.compile(graph_, window_, held_);
  workspace_.allocate(problem_);
}

LocalPlanner::Attempt LocalPlanner::optimise(CycleReport& report, const Deadline& deadline) {
  Stopwatch watch;
  optimiser_.options().deadline = deadline;
  optimiser_.start(workspace_, *solver_);
  while (optimiser_.iterate()) {
  }
  const OptimiserResult& result = optimiser_.result();
  report.iterations += result.iterations;
  for (const IterationStatistics& step : result.statistics) {
    report.time_linearise += step.time_linearise;
    report.time_solve += step.time_solve;
    report.time_evaluate += step.time_evaluate;
  }
  report.time_optimise += watch.lap();
  // The last trial may have been refused: derive the accepted state before reading its errors.
  Attempt attempt;
  attempt.cost = workspace_.evaluate(workspace_.state());
  attempt.violation = check_window(workspace_, violated_);
  report.time_check += watch.lap();
  return attempt;
}

double LocalPlanner::behind_m(int index) const {
  const Eigen::Vector3d behind = planned_[index].head<3>() - configuration(index).head<3>();
  const Eigen::Vector3d left = DetourSearch::left(planned_[index].data());
  return behind.dot(left.cross(Eigen::Vector3d::UnitZ()));
}

/// The window as planned, moved sideways; wheels steered along the way and turned to match.
void LocalPlanner::apply_detour(int executed, int last) {
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
  const std::vector<double> offsets = detour_.find(plan, times, plan_.world->now, start, slope);

  for (int i = executed + 1; i <= last; ++i) {
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
    configuration(i) = q;
    before = q;
  }
}

void LocalPlanner::raise_weights() {
  for (const ViolatedEdge& edge : violated_) {
    EdgePool& pool = *graph_.edge_pools()[edge.pool];
    const int index = problem_.edges()[edge.pool].edges[edge.k];
    const Eigen::MatrixXd information = pool.information(index);
    raised_.push_back({&pool, index, information});
    pool.set_information(index, options_.raise * information);
  }
}

void LocalPlanner::restore_weights() {
  // Backwards: an edge raised twice gets its first weight last.
  for (auto raised = raised_.rbegin(); raised != raised_.rend(); ++raised) {
    raised->pool->set_information(raised->index, raised->information);
  }
  raised_.clear();
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

  Stopwatch watch;
  enter(executed, last);
  compile(executed, last);
  workspace_.load_state();
  report.time_compile = watch.lap();

  Attempt best = optimise(report, deadline);
  std::vector<double> best_state = workspace_.state();
  const auto better = [](const Attempt& a, const Attempt& b) {
    if (a.violation.any() != b.violation.any()) return !a.violation.any();
    return a.cost.robust < b.cost.robust;
  };
  workspace_.store_state();
  const bool blocked = executed >= detour_not_before_ && behind_m(last) > options_.blocked_m;
  if ((best.violation.any() || blocked) && !deadline.passed()) {
    report.detour = true;
    watch.lap();
    apply_detour(executed, last);
    workspace_.load_state();
    report.time_detour = watch.lap();
    const Attempt detour = optimise(report, deadline);
    if (better(detour, best)) {
      best = detour;
      best_state = workspace_.state();
    } else {
      detour_not_before_ = executed + 1 + options_.detour_pause;
      workspace_.state() = best_state;
      workspace_.evaluate(workspace_.state());
      check_window(workspace_, violated_);
    }
    for (; best.violation.any() && report.rounds < options_.max_rounds && !deadline.passed();
         ++report.rounds) {
      raise_weights();
      const Attempt round = optimise(report, deadline);
      // Costs under raised weights do not compare: less violation is better.
      if (!round.violation.any() || round.violation.worst < best.violation.worst) {
        best = round;
        best_state = workspace_.state();
      }
    }
    restore_weights();
  }
  workspace_.state() = best_state;
  workspace_.store_state();
  report.violation = best.violation;
  report.feasible = !best.violation.any();
  report.next_feasible = report.feasible;
  if (!report.feasible) {
    // Only what comes next has to hold now; the rest has time to be mended.
    compile(executed, executed + 1);
    workspace_.load_state();
    workspace_.evaluate(workspace_.state());
    report.next_feasible = !check_window(workspace_, violated_).any();
  }
  report.time_total = cycle_watch.seconds();
  report.deadline_missed = options_.deadline_s > 0.0 && report.time_total > options_.deadline_s;
  return report;
}

}  // namespace locograph
