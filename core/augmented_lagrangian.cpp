#include <locograph/common/check_option.h>
#include <locograph/core/augmented_lagrangian.h>
#include <locograph/core/weighted_square.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace locograph {
namespace {

using ConstrainedReason = ConstrainedResult::Reason;

/// The cost of the edges that are no constraints, at the state evaluated last.
Cost plain_cost(Workspace& workspace) {
  const Problem& problem = workspace.problem();
  Cost total;
  Eigen::VectorXd e;
  for (std::size_t p = 0; p < problem.edges().size(); ++p) {
    EdgePool& pool = *problem.graph().edge_pools()[p];
    const CompiledEdges& compiled = problem.edges()[p];
    for (std::size_t k = 0; k < compiled.edges.size(); ++k) {
      if (!compiled.constraint_row.empty() && compiled.constraint_row[k] >= 0) continue;
      const int index = compiled.edges[k];
      e.resize(pool.dimension(index));
      workspace.error(static_cast<int>(p), static_cast<int>(k), e.data());
      const double chi2 = weighted_square(pool, index, e);
      total += {pool.kernel(index).weights(chi2).cost, chi2};
    }
  }
  return total;
}

bool gave_up(OptimiserResult::Reason reason) {
  using Inner = OptimiserResult::Reason;
  return reason == Inner::kDeadline || reason == Inner::kSingular || reason == Inner::kNotFinite ||
         reason == Inner::kDiverged || reason == Inner::kStopped;
}

}  // namespace

/// The outer loop's book-keeping, by constraint row.
class ConstrainedOptimiser::Rows {
 public:
  explicit Rows(const ConstrainedOptions& options) : options_(options) {}

  /// Keeps its memory.
  void start(Workspace& workspace, bool warm) {
    workspace_ = &workspace;
    problem_ = &workspace.problem();
    const std::vector<ConstraintRow>& rows = std::as_const(workspace).constraint_rows();
    const std::size_t count = rows.size();
    violation_.assign(count, 0.0);
    last_.assign(count, std::numeric_limits<double>::infinity());
    joint_.assign(problem_->constraints().size(), false);
    for (std::size_t i = 0; i < problem_->constraints().size(); ++i) {
      const CompiledConstraint& c = problem_->constraints()[i];
      // A limit on hundreds of rows has its weights, not a matrix of their square.
      if (pool(c).has_weights()) continue;
      joint_[i] = !pool(c).information(index(c)).isDiagonal(0.0);
    }
    if (warm) return;
    for (ConstraintRow& row : workspace.constraint_rows()) {
      row.shift = 0.0;
      row.scale = std::sqrt(options_.initial_penalty);
    }
  }

  /// Reads the errors at the state evaluated last.
  void measure() {
    const std::vector<ConstraintRow>& rows = std::as_const(*workspace_).constraint_rows();
    for (const CompiledConstraint& c : problem_->constraints()) {
      const bool hinged = pool(c).one_sided(), one_sided = is_one_sided(c);
      for (int r = 0; r < c.count; ++r) {
        const double e = error(c.row + r);
        // How far the row is from satisfying its complementarity condition, N&W eq. 17.66.
        violation_[c.row + r] = e == 0.0 || pool(c).weight(index(c), r) == 0.0 ? 0.0
                                : !one_sided || hinged
                                    ? std::abs(e)
                                    : std::abs(std::max(e, -rows[c.row + r].shift));
      }
    }
  }

  bool satisfied() const {
    for (const CompiledConstraint& c : problem_->constraints()) {
      for (int r = 0; r < c.count; ++r) {
        if (is_off(c, r)) return false;
      }
    }
    return true;
  }

  /// Multipliers, then penalties. False when nothing is left to raise.
  bool update() {
    std::vector<ConstraintRow>& rows = workspace_->constraint_rows();
    bool exhausted = false;
    for (std::size_t i = 0; i < problem_->constraints().size(); ++i) {
      const CompiledConstraint& c = problem_->constraints()[i];
      const bool hinged = pool(c).one_sided();
      bool any = false;
      for (int r = 0; r < c.count; ++r) {
        ConstraintRow& row = rows[c.row + r];
        if (!hinged) {
          row.shift += error(c.row + r);
          if (is_one_sided(c)) row.shift = std::max(0.0, row.shift);
        }
        any = any || slow(c, r);
      }
      for (int r = 0; r < c.count; ++r) {
        if (joint_[i] ? any : slow(c, r)) exhausted = !raise(rows[c.row + r]) || exhausted;
      }
    }
    last_ = violation_;
    return !exhausted;
  }

  /// Violations at the end of the last round.
  std::vector<double>& last() { return last_; }

  void report(ConstrainedResult& result) const {
    const std::vector<ConstraintRow>& rows = std::as_const(*workspace_).constraint_rows();
    double most = -1.0;
    for (std::size_t i = 0; i < problem_->constraints().size(); ++i) {
      const CompiledConstraint& c = problem_->constraints()[i];
      ConstraintState state;
      state.edge = {c.edge};
      state.multipliers.resize(c.count);
      const bool weighted = pool(c).has_weights();
      const Eigen::MatrixXd information =
          weighted ? Eigen::MatrixXd() : pool(c).information(index(c));
      Eigen::VectorXd scaled_shift(c.count);
      for (int r = 0; r < c.count; ++r) {
        const ConstraintRow& row = rows[c.row + r];
        scaled_shift[r] = row.scale * row.shift;
        const double e = error(c.row + r);
        const double violation = pool(c).weight(index(c), r) == 0.0 ? 0.0
                                 : is_one_sided(c)                  ? std::max(0.0, e)
                                                                    : std::abs(e);
        if (violation > state.violation) {
          state.violation = violation;
          state.row = r;
        }
      }
      for (int r = 0; r < c.count; ++r) {
        const double force = weighted ? pool(c).weight(index(c), r) * scaled_shift[r]
                                      : information.row(r).dot(scaled_shift);
        state.multipliers[r] = 2.0 * rows[c.row + r].scale * force;
      }
      if (state.violation > most) {
        most = state.violation;
        result.worst = static_cast<int>(i);
      }
      result.constraints.push_back(std::move(state));
    }
  }

 private:
  const EdgePool& pool(const CompiledConstraint& c) const {
    return *problem_->graph().edge_pools()[c.pool];
  }
  int index(const CompiledConstraint& c) const { return problem_->edges()[c.pool].edges[c.k]; }
  static bool is_one_sided(const CompiledConstraint& c) {
    return c.kind == ConstraintKind::kInequality;
  }
  double error(int row) const { return workspace_->constraint_errors()[row]; }
  /// Of thousands of rows few are: the others are not asked what they tolerate.
  bool is_off(const CompiledConstraint& c, int r) const {
    const double violation = violation_[c.row + r];
    return violation != 0.0 && !(violation <= tolerance(c, r));
  }
  bool slow(const CompiledConstraint& c, int r) const {
    return violation_[c.row + r] > options_.decrease * last_[c.row + r] && is_off(c, r);
  }
  double tolerance(const CompiledConstraint& c, int r) const {
    if (!options_.own_tolerances) return options_.tolerance;
    const double of_edge = problem_->graph().edge_record(c.edge).tolerance;
    if (of_edge > 0.0) return of_edge;
    const double of_type = pool(c).row_tolerance(problem_->edges()[c.pool], c.k, r);
    return of_type > 0.0 ? of_type : options_.tolerance;
  }
  /// Keeps the multiplier: λ = 2μ Ω shift.
  bool raise(ConstraintRow& row) const {
    const double penalty = row.scale * row.scale * options_.growth;
    if (penalty > options_.max_penalty * (1.0 + 1e-9)) return false;
    row.scale = std::sqrt(penalty);
    row.shift /= options_.growth;
    return true;
  }

  Workspace* workspace_ = nullptr;
  const Problem* problem_ = nullptr;
  const ConstrainedOptions& options_;
  std::vector<double> violation_, last_;
  std::vector<bool> joint_;  ///< Ω is not diagonal
};

void ConstrainedOptions::validate() const {
  inner.validate();
  check_option(max_rounds >= 1, "max_rounds", "1 or more");
  check_option(tolerance > 0.0, "tolerance", "a positive number");
  check_option(initial_penalty > 0.0, "initial_penalty", "a positive number");
  check_option(growth > 1.0, "growth", "a factor > 1");
  check_option(max_penalty >= initial_penalty, "max_penalty", "initial_penalty or more");
  check_option(decrease > 0.0 && decrease < 1.0, "decrease", "a fraction in (0, 1)");
}

std::string ConstrainedResult::reason_text(const Graph& graph) const {
  std::ostringstream text;
  switch (reason) {
    case ConstrainedReason::kConverged:
      text << "converged: every constraint is satisfied";
      break;
    case ConstrainedReason::kInfeasible:
      text << "infeasible: a constraint stays violated at the largest penalty";
      break;
    case ConstrainedReason::kMaxRounds:
      text << "the rounds are used up";
      break;
    case ConstrainedReason::kInnerFailed:
      text << inner.reason_text();
      break;
  }
  if (worst >= 0 && !converged) {
    const ConstraintState& state = constraints[worst];
    text << "; worst is " << graph.edge_pools()[graph.edge_record(state.edge.slot).pool]->tag();
    for (const int v : graph.edge_vertices(state.edge.slot)) {
      text << ' ' << graph.vertex_record(v).id;
    }
    text << ", row " << state.row << ", violated by " << state.violation;
  }
  return text.str();
}

ConstrainedOptimiser::ConstrainedOptimiser(const ConstrainedOptions& options)
    : options_(options), inner_(options.inner), rows_(std::make_unique<Rows>(options_)) {
  options.validate();
}

ConstrainedOptimiser::~ConstrainedOptimiser() = default;

void ConstrainedOptimiser::start(Workspace& workspace, LinearSolver& solver, bool warm,
                                 bool evaluated) {
  workspace_ = &workspace;
  solver_ = &solver;
  rows_->start(workspace, warm);
  reason_ = ConstrainedReason::kMaxRounds;
  rounds_ = finished_iterations_ = round_iterations_ = 0;
  raised_ = true;
  over_ = goes_on_ = false;
  inner_.start(workspace, solver, evaluated);
}

void ConstrainedOptimiser::go_on(Workspace& workspace, LinearSolver& solver, bool evaluated) {
  const bool raised = raised_;
  const int rounds = rounds_, iterations = this->iterations(), of_round = round_iterations_;
  start(workspace, solver, true, evaluated);
  raised_ = raised;
  rounds_ = rounds;
  finished_iterations_ = iterations;
  round_iterations_ = of_round;
  goes_on_ = true;
}

std::vector<double>& ConstrainedOptimiser::last_violations() { return rows_->last(); }

bool ConstrainedOptimiser::iterate() {
  constexpr int kOfARound = 3;
  if (over_) return false;
  const bool more = inner_.iterate();
  ++round_iterations_;
  if (more && !(goes_on_ && round_iterations_ >= kOfARound)) return true;
  over_ = !end_round(more);
  return !over_;
}

/// Whether there is another round. cut_short: this one might have gone on.
bool ConstrainedOptimiser::end_round(bool cut_short) {
  ++rounds_;
  round_iterations_ = 0;
  goes_on_ = false;
  workspace_->return_to_state();
  rows_->measure();
  if (gave_up(inner_.result().reason)) {
    reason_ = ConstrainedReason::kInnerFailed;
    return false;
  }
  cut_short = cut_short || inner_.result().reason == OptimiserResult::Reason::kMaxIterations;
  if (rows_->satisfied() && !cut_short) {
    rows_->update();
    reason_ = ConstrainedReason::kConverged;
  } else if (!raised_) {
    reason_ = ConstrainedReason::kInfeasible;
  } else {
    raised_ = rows_->update();
    if (rounds_ < options_.max_rounds) {
      finished_iterations_ += inner_.result().iterations;
      inner_.start(*workspace_, *solver_, true);
      return true;
    }
  }
  return false;
}

ConstrainedResult ConstrainedOptimiser::result() {
  ConstrainedResult result;
  result.reason = reason_;
  result.converged = reason_ == ConstrainedReason::kConverged;
  result.rounds = rounds_;
  result.iterations = iterations();
  result.inner = inner_.result();
  result.cost = plain_cost(*workspace_);
  rows_->report(result);
  return result;
}

ConstrainedResult optimise_constrained(Workspace& workspace, const ConstrainedOptions& options,
                                       LinearSolver& solver, bool warm) {
  ConstrainedOptimiser optimiser(options);
  optimiser.start(workspace, solver, warm);
  while (optimiser.iterate()) {
  }
  return optimiser.result();
}

ConstrainedResult optimise_constrained(Graph& graph, const ConstrainedOptions& options,
                                       LinearSolver& solver) {
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  const ConstrainedResult result = optimise_constrained(workspace, options, solver);
  workspace.store_state();
  return result;
}

}  // namespace locograph
