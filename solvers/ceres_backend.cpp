#include <ceres/ceres.h>
#include <locograph/solvers/ceres_backend.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

/// A vertex's own ⊞.
class VertexManifold final : public ceres::Manifold {
 public:
  VertexManifold(const VertexPool& pool, int index) : pool_(pool), vertex_{index, 0, 0} {}

  int AmbientSize() const override { return pool_.state_size(vertex_.index); }
  int TangentSize() const override { return pool_.dimension(vertex_.index); }
  bool Plus(const double* x, const double* delta, double* out) const override {
    std::copy_n(x, AmbientSize(), out);
    pool_.oplus({&vertex_, 1}, x, delta, out);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor>(jacobian, AmbientSize(), TangentSize()).setIdentity();
    return true;
  }
  // The solver asks for neither.
  bool Minus(const double*, const double*, double*) const override { return false; }
  bool MinusJacobian(const double*, double*) const override { return false; }

 private:
  const VertexPool& pool_;
  ActiveVertex vertex_;
};

class KernelLoss final : public ceres::LossFunction {
 public:
  explicit KernelLoss(const RobustKernel& kernel) : kernel_(kernel) {}
  /// Without the second derivative Ceres weights by ρ' alone, as we do.
  void Evaluate(double squared, double rho[3]) const override {
    const RobustKernel::Weights weights = kernel_.weights(squared);
    rho[0] = weights.cost;
    rho[1] = weights.weight;
    rho[2] = 0.0;
  }

 private:
  RobustKernel kernel_;
};

/// R with RᵀR = Ω.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& information) {
  if (information.isDiagonal(0.0)) return information.cwiseSqrt();
  const Eigen::LLT<Eigen::MatrixXd> cholesky(information);
  if (cholesky.info() == Eigen::Success) return cholesky.matrixU();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(information);
  return eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         eigen.eigenvectors().transpose();
}

/// One edge, compiled for itself: its vertices' states are copied one behind the other.
class EdgeCost final : public ceres::CostFunction {
 public:
  EdgeCost(const EdgePool& pool, const CompiledEdges& compiled, int k)
      : pool_(pool), root_(square_root(pool.information(compiled.edges[k]))) {
    edge_.clear();
    edge_.edges.push_back(compiled.edges[k]);
    int state = 0;
    for (int s = compiled.slot_begin[k]; s < compiled.slot_begin[k + 1]; ++s) {
      CompiledEdges::Slot slot = compiled.slots[s];
      const int pool_number = local_pool(slot.pool);
      slot.pool_number = pool_number;
      slot.derived_index = static_cast<int>(vertices_[pool_number].size());
      slot.state_offset = state;
      slot.tangent_offset = 0;
      vertices_[pool_number].push_back({slot.vertex_index, state, 0});
      state += slot.pool->state_size(slot.vertex_index);
      mutable_parameter_block_sizes()->push_back(slot.pool->state_size(slot.vertex_index));
      edge_.slots.push_back(slot);
    }
    edge_.slot_begin.push_back(static_cast<int>(edge_.slots.size()));
    state_.resize(state);
    for (std::size_t p = 0; p < pools_.size(); ++p) {
      derived_.push_back(pools_[p]->make_derived(vertices_[p]));
    }
    scratch_.reserve(pool.scratch_bytes(edge_));
    const int dimension = pool.dimension(compiled.edges[k]);
    set_num_residuals(dimension);
    error_.resize(dimension);
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    for (std::size_t s = 0; s < edge_.slots.size(); ++s) {
      std::copy_n(parameters[s], parameter_block_sizes()[s],
                  state_.data() + edge_.slots[s].state_offset);
    }
    for (std::size_t p = 0; p < pools_.size(); ++p) {
      if (derived_[p])
        pools_[p]->derive(vertices_[p], 0, vertices_[p].size(), state_.data(), *derived_[p]);
    }
    const Evaluation x{state_.data(), derived_, &scratch_};
    pool_.error(edge_, 0, x, error_.data());
    if (!error_.allFinite()) return false;
    Eigen::Map<Eigen::VectorXd>(residuals, error_.size()) = root_ * error_;
    if (jacobians == nullptr) return true;
    for (std::size_t s = 0; s < edge_.slots.size(); ++s) {
      if (jacobians[s] == nullptr) continue;
      Eigen::MatrixXd jacobian = pool_.jacobian(edge_, 0, static_cast<int>(s), x, false);
      if (pool_.one_sided()) {
        for (Eigen::Index r = 0; r < error_.size(); ++r) {
          if (error_[r] == 0.0) jacobian.row(r).setZero();
        }
      }
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      Eigen::Map<RowMajor> out(jacobians[s], error_.size(), parameter_block_sizes()[s]);
      out.setZero();
      out.leftCols(jacobian.cols()) = root_ * jacobian;
    }
    return true;
  }

 private:
  int local_pool(const VertexPool* pool) {
    const auto known = std::find(pools_.begin(), pools_.end(), pool);
    if (known == pools_.end()) {
      pools_.push_back(pool);
      vertices_.emplace_back();
      return static_cast<int>(pools_.size()) - 1;
    }
    return static_cast<int>(known - pools_.begin());
  }

  const EdgePool& pool_;
  Eigen::MatrixXd root_;
  CompiledEdges edge_;
  std::vector<const VertexPool*> pools_;
  std::vector<std::vector<ActiveVertex>> vertices_;
  // Ceres evaluates one cost function on one thread at a time.
  std::vector<std::unique_ptr<DerivedStore>> derived_;
  mutable Scratch scratch_;
  mutable std::vector<double> state_;
  mutable Eigen::VectorXd error_;
};

/// The graph as a ceres::Problem on a state of its own.
class CeresProblem {
 public:
  explicit CeresProblem(Graph& graph) {
    problem_.compile(graph);
    // Those of a type that is an equality or hinges by itself are ordinary edges to anybody else.
    const auto& all = problem_.constraints();
    if (std::any_of(all.begin(), all.end(), [&graph](const CompiledConstraint& c) {
          const EdgePool& pool = *graph.edge_pools()[c.pool];
          return c.kind != pool.constraint() ||
                 (c.kind == ConstraintKind::kInequality && !pool.one_sided());
        })) {
      throw Error("Ceres cannot solve a graph with constraints", "no edge marked as a constraint");
    }
    workspace_.allocate(problem_);
    workspace_.load_state();
    add_vertices();
    add_edges();
  }

  ceres::Problem& ceres() { return ceres_; }
  Workspace& workspace() { return workspace_; }
  const Problem& problem() const { return problem_; }
  /// Parameter blocks of the free vertices, in the order of Problem::free_vertices().
  const std::vector<double*>& free_blocks() const { return free_blocks_; }

 private:
  void add_vertices() {
    const Graph& graph = problem_.graph();
    std::vector<double*> block_at(problem_.dimension(), nullptr);
    for (std::size_t p = 0; p < problem_.active().size(); ++p) {
      const VertexPool& pool = *graph.vertex_pools()[p];
      for (const ActiveVertex& v : problem_.active()[p]) {
        double* block = workspace_.state().data() + v.state_offset;
        ceres_.AddParameterBlock(block, pool.state_size(v.index),
                                 new VertexManifold(pool, v.index));
        if (v.tangent_offset < 0) {
          ceres_.SetParameterBlockConstant(block);
        } else {
          block_at[v.tangent_offset] = block;
        }
      }
    }
    for (int b = 0; b < problem_.pattern().size(); ++b) {
      free_blocks_.push_back(block_at[problem_.pattern().scalar_begin[b]]);
    }
  }

  void add_edges() {
    const Graph& graph = problem_.graph();
    for (std::size_t p = 0; p < problem_.edges().size(); ++p) {
      EdgePool& pool = *graph.edge_pools()[p];
      const CompiledEdges& compiled = problem_.edges()[p];
      for (int k = 0; k < static_cast<int>(compiled.edges.size()); ++k) {
        std::vector<double*> blocks;
        for (int s = compiled.slot_begin[k]; s < compiled.slot_begin[k + 1]; ++s) {
          blocks.push_back(workspace_.state().data() + compiled.slots[s].state_offset);
        }
        const RobustKernel& kernel = pool.kernel(compiled.edges[k]);
        ceres_.AddResidualBlock(
            new EdgeCost(pool, compiled, k),
            kernel.kind == RobustKernel::Kind::kNone ? nullptr : new KernelLoss(kernel), blocks);
      }
    }
  }

  Problem problem_;
  Workspace workspace_;
  ceres::Problem ceres_;
  std::vector<double*> free_blocks_;
};

/// Collects the statistics, asks the caller and the clock.
class Observer final : public ceres::IterationCallback {
 public:
  Observer(const OptimiserOptions& options, OptimiserResult& result)
      : options_(options), result_(result) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& now) override {
    if (now.iteration == 0) return ceres::SOLVER_CONTINUE;
    pending_ += now.step_is_successful ? 0 : 1;
    if (now.step_is_successful) {
      IterationStatistics statistics;
      statistics.cost = 2.0 * now.cost;
      statistics.chi2 = statistics.cost;
      statistics.gain_ratio = now.relative_decrease;
      statistics.lambda = 1.0 / now.trust_region_radius;
      statistics.step_norm = now.step_norm;
      statistics.refusals = pending_;
      statistics.time_solve = now.step_solver_time_in_seconds;
      statistics.time_linearise = now.iteration_time_in_seconds - now.step_solver_time_in_seconds;
      pending_ = 0;
      ++result_.iterations;
      result_.statistics.push_back(statistics);
      result_.final.robust = statistics.cost;
      if (options_.on_iteration && !options_.on_iteration(result_)) {
        stopped = true;
        return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
      }
    }
    if (options_.deadline.passed()) {
      late = true;
      return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
    }
    return ceres::SOLVER_CONTINUE;
  }

  bool stopped = false, late = false;

 private:
  const OptimiserOptions& options_;
  OptimiserResult& result_;
  int pending_ = 0;
};

ceres::Solver::Options solver_options(const OptimiserOptions& options, const CeresProblem& problem,
                                      int threads) {
  ceres::Solver::Options out;
  out.trust_region_strategy_type =
      options.algorithm == Algorithm::kDogleg ? ceres::DOGLEG : ceres::LEVENBERG_MARQUARDT;
  out.max_num_iterations = options.max_iterations;
  out.function_tolerance = options.gain;
  out.gradient_tolerance = options.gradient_tolerance;
  out.parameter_tolerance = options.step_tolerance;
  out.max_num_consecutive_invalid_steps = options.max_refusals;
  out.num_threads = threads;
  out.logging_type = ceres::SILENT;
  const BlockPattern& pattern = problem.problem().pattern();
  out.linear_solver_type =
      pattern.kept < pattern.size() ? ceres::SPARSE_SCHUR : ceres::SPARSE_NORMAL_CHOLESKY;
  if (pattern.kept < pattern.size()) {
    out.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
    for (int b = 0; b < pattern.size(); ++b) {
      out.linear_solver_ordering->AddElementToGroup(problem.free_blocks()[b],
                                                    b < pattern.kept ? 1 : 0);
    }
  }
  return out;
}

OptimiserResult::Reason reason_of(const ceres::Solver::Summary& summary, const Observer& observer,
                                  const OptimiserOptions& options) {
  using Reason = OptimiserResult::Reason;
  if (observer.stopped) return Reason::kStopped;
  if (observer.late) return Reason::kDeadline;
  switch (summary.termination_type) {
    case ceres::CONVERGENCE:
      if (summary.message.starts_with("Gradient")) return Reason::kGradient;
      if (summary.message.starts_with("Parameter")) return Reason::kStep;
      return Reason::kGain;
    case ceres::NO_CONVERGENCE:
      return static_cast<int>(summary.iterations.size()) > options.max_iterations
                 ? Reason::kMaxIterations
                 : Reason::kNoProgress;
    default:
      return Reason::kNoProgress;
  }
}

}  // namespace

OptimiserResult optimise_with_ceres(Graph& graph, const OptimiserOptions& options, int threads) {
  using Reason = OptimiserResult::Reason;
  options.validate();
  if (options.algorithm == Algorithm::kGaussNewton) {
    throw Error("Ceres has no plain Gauss-Newton", "Levenberg-Marquardt or dogleg");
  }
  CeresProblem problem(graph);
  Workspace& workspace = problem.workspace();
  OptimiserResult result;
  result.initial = result.final = workspace.evaluate(workspace.state());
  if (problem.problem().dimension() == 0) {
    result.reason = Reason::kNothingToDo;
  } else if (!std::isfinite(result.initial.robust)) {
    result.reason = Reason::kNotFinite;
  } else {
    ceres::Solver::Options solver = solver_options(options, problem, threads);
    Observer observer(options, result);
    solver.callbacks.push_back(&observer);
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem.ceres(), &summary);
    result.reason = reason_of(summary, observer, options);
    result.final = workspace.evaluate(workspace.state());
    workspace.store_state();
  }
  result.converged = result.reason == Reason::kGain || result.reason == Reason::kGradient ||
                     result.reason == Reason::kStep || result.reason == Reason::kNothingToDo;
  return result;
}

CeresEvaluation evaluate_with_ceres(Graph& graph) {
  CeresProblem problem(graph);
  CeresEvaluation out;
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = problem.free_blocks();
  if (!problem.ceres().Evaluate(options, &out.cost, nullptr, &out.gradient, nullptr)) {
    throw Error("Ceres cannot evaluate the graph", "finite errors");
  }
  out.cost *= 2.0;
  return out;
}

}  // namespace locograph
