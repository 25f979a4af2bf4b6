#include <locograph/common/check_option.h>
#include <locograph/core/augmented_lagrangian.h>
#include <locograph/core/weighted_square.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace locograph {
namespace {

using ConstrainedReason = ConstrainedResult::Reason;

/// The outer loop's book-keeping, by constraint row.
class OuterLoop {
 public:
  OuterLoop(Workspace& workspace, const ConstrainedOptions& options, bool warm)
      : workspace_(workspace),
        problem_(workspace.problem()),
        rows_(workspace.constraint_rows()),
        options_(options) {
    const std::size_t count = rows_.size();
    error_.resize(count);
    violation_.assign(count, 0.0);
    last_.assign(count, std::numeric_limits<double>::infinity());
    weight_.resize(count);
    tolerance_.resize(count);
    information_.resize(problem_.constraints().size());
    joint_.resize(problem_.constraints().size());
    for (std::size_t i = 0; i < problem_.constraints().size(); ++i) {
      const CompiledConstraint& c = problem_.constraints()[i];
      const int index = problem_.edges()[c.pool].edges[c.k];
      // A limit on hundreds of rows has its weights, not a matrix of their square.
      if (!pool(c).has_weights()) {
        information_[i] = pool(c).information(index);
        joint_[i] = !information_[i].isDiagonal(0.0);
      }
      for (int r = 0; r < c.count; ++r) {
        weight_[c.row + r] = pool(c).weight(index, r);
        tolerance_[c.row + r] = tolerance(c, r);
      }
    }
    if (warm) return;
    for (ConstraintRow& row : rows_) {
      row.shift = 0.0;
      row.scale = std::sqrt(options.initial_penalty);
    }
  }

  /// Reads the errors at the state evaluated last.
  void measure() {
    for (const CompiledConstraint& c : problem_.constraints()) {
      workspace_.error(c.pool, c.k, error_.data() + c.row);
      const bool hinged = pool(c).one_sided();
      for (int r = c.row; r < c.row + c.count; ++r) {
        const double e = error_[r];
        // How far the row is from satisfying its complementarity condition, N&W eq. 17.66.
        violation_[r] = weight_[r] == 0.0               ? 0.0
                        : !rows_[r].one_sided || hinged ? std::abs(e)
                                                        : std::abs(std::max(e, -rows_[r].shift));
      }
    }
  }

  bool satisfied() const {
    return std::equal(violation_.begin(), violation_.end(), tolerance_.begin(),
                      [](double violation, double tolerance) { return violation <= tolerance; });
  }

  /// Multipliers, then penalties. False when nothing is left to raise.
  bool update() {
    bool exhausted = false;
    for (std::size_t i = 0; i < problem_.constraints().size(); ++i) {
      const CompiledConstraint& c = problem_.constraints()[i];
      const bool hinged = pool(c).one_sided();
      bool any = false;
      for (int r = c.row; r < c.row + c.count; ++r) {
        if (!hinged) {
          rows_[r].shift += error_[r];
          if (rows_[r].one_sided) rows_[r].shift = std::max(0.0, rows_[r].shift);
        }
        any = any || slow(r);
      }
      for (int r = c.row; r < c.row + c.count; ++r) {
        if (joint_[i] ? any : slow(r)) exhausted = !raise(rows_[r]) || exhausted;
      }
    }
    last_ = violation_;
    return !exhausted;
  }

  void report(ConstrainedResult& result) const {
    double most = -1.0;
    for (std::size_t i = 0; i < problem_.constraints().size(); ++i) {
      const CompiledConstraint& c = problem_.constraints()[i];
      ConstraintState state;
      state.edge = {c.edge};
      state.multipliers.resize(c.count);
      const bool weighted = information_[i].size() == 0;
      Eigen::VectorXd scaled_shift(c.count);
      for (int r = 0; r < c.count; ++r) {
        const ConstraintRow& row = rows_[c.row + r];
        scaled_shift[r] = row.scale * row.shift;
        const double e = error_[c.row + r];
        const double violation = weight_[c.row + r] == 0.0 ? 0.0
                                 : row.one_sided           ? std::max(0.0, e)
                                                           : std::abs(e);
        if (violation > state.violation) {
          state.violation = violation;
          state.row = r;
        }
      }
      for (int r = 0; r < c.count; ++r) {
        const double force = weighted ? weight_[c.row + r] * scaled_shift[r]
                                      : information_[i].row(r).dot(scaled_shift);
        state.multipliers[r] = 2.0 * rows_[c.row + r].scale * force;
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
    return *problem_.graph().edge_pools()[c.pool];
  }
  bool slow(int r) const {
    return violation_[r] > tolerance_[r] && violation_[r] > options_.decrease * last_[r];
  }
  double tolerance(const CompiledConstraint& c, int r) const {
    if (!options_.own_tolerances) return options_.tolerance;
    const double of_edge = problem_.graph().edge_record(c.edge).tolerance;
    if (of_edge > 0.0) return of_edge;
    const double of_type = pool(c).row_tolerance(problem_.edges()[c.pool], c.k, r);
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

  Workspace& workspace_;
  const Problem& problem_;
  std::vector<ConstraintRow>& rows_;
  const ConstrainedOptions& options_;
  std::vector<double> error_, violation_, last_, weight_, tolerance_;
  std::vector<Eigen::MatrixXd> information_;  ///< empty for edges with weights
  std::vector<bool> joint_;                   ///< Ω is not diagonal
};

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

ConstrainedResult optimise_constrained(Workspace& workspace, const ConstrainedOptions& options,
                                       LinearSolver& solver, bool warm) {
  options.validate();
  OuterLoop rounds(workspace, options, warm);
  ConstrainedResult result;
  Optimiser optimiser(options.inner);
  bool raised = true;
  while (result.rounds < options.max_rounds) {
    optimiser.start(workspace, solver);
    while (optimiser.iterate()) {
    }
    ++result.rounds;
    result.inner = optimiser.result();
    result.iterations += result.inner.iterations;
    workspace.evaluate(workspace.state());
    rounds.measure();
    if (gave_up(result.inner.reason)) {
      result.reason = ConstrainedReason::kInnerFailed;
      break;
    }
    if (rounds.satisfied() && result.inner.reason != OptimiserResult::Reason::kMaxIterations) {
      rounds.update();
      result.reason = ConstrainedReason::kConverged;
      break;
    }
    if (!raised) {
      result.reason = ConstrainedReason::kInfeasible;
      break;
    }
    raised = rounds.update();
  }
  result.converged = result.reason == ConstrainedReason::kConverged;
  result.cost = plain_cost(workspace);
  rounds.report(result);
  return result;
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
