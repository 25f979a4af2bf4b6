#include <locograph/core/weighted_square.h>
#include <locograph/core/workspace.h>

#include <algorithm>

namespace locograph {

void Workspace::allocate(const Problem& problem) {
  problem_ = &problem;
  bindings_.clear();
  state_.resize(problem.state_size());
  trial_.resize(problem.state_size());
  hessian_.resize(problem.hessian_reductions().size);
  const int n = problem.dimension();
  gradient_.resize(problem.gradient_reductions().size);
  step_.resize(n);
  damping_.assign(n, 0.0);
  constraint_rows_.assign(problem.constraint_rows(), {});
  constraint_errors_.assign(problem.constraint_rows(), 0.0);
  evaluated_ = derived_from_ = nullptr;
  for (const CompiledConstraint& c : problem.constraints()) {
    for (int r = c.row; r < c.row + c.count; ++r) {
      constraint_rows_[r].one_sided = c.kind == ConstraintKind::kInequality;
    }
  }
  const std::size_t pools = problem.active().size();
  derived_.resize(pools);
  derived_for_.resize(pools);
  for (std::size_t p = 0; p < pools; ++p) {
    const VertexPool& pool = *problem.graph().vertex_pools()[p];
    const std::vector<ActiveVertex>& active = problem.active()[p];
    // A store whose places have the same sizes serves a window that slid or got shorter.
    if (derived_[p] && derived_for_[p].fits(pool, active)) continue;
    derived_[p] = pool.make_derived(active);
    if (derived_[p]) derived_for_[p].assign(pool, active);
  }
  if (static_cast<int>(scratch_.size()) < problem.chunks()) scratch_.resize(problem.chunks());
  for (Scratch& scratch : scratch_) scratch.reserve(problem.scratch_bytes());
  chunk_costs_.resize(problem.chunks());
}

bool Workspace::DerivedFor::fits(const VertexPool& other,
                                 std::span<const ActiveVertex> active) const {
  if (pool != &other || type != other.type()) return false;
  return active.size() <= state_sizes.size() &&
         std::equal(
             active.begin(), active.end(), state_sizes.begin(),
             [&](const ActiveVertex& v, int size) { return other.state_size(v.index) == size; });
}

void Workspace::DerivedFor::assign(const VertexPool& other, std::span<const ActiveVertex> active) {
  pool = &other;
  type = other.type();
  state_sizes.clear();
  for (const ActiveVertex& v : active) state_sizes.push_back(other.state_size(v.index));
}

void Workspace::bind(const Bindings& bindings) {
  bindings.require_fit(problem_->graph().parameters());
  bindings_ = bindings;
  evaluated_ = nullptr;
}

void Workspace::load_state() {
  for (std::size_t p = 0; p < problem_->active().size(); ++p) {
    const VertexPool& pool = *problem_->graph().vertex_pools()[p];
    for (const ActiveVertex& v : problem_->active()[p]) {
      const double* from = pool.state(v.index);
      std::copy(from, from + pool.state_size(v.index), state_.begin() + v.state_offset);
    }
  }
  trial_ = state_;
  evaluated_ = derived_from_ = nullptr;
}

void Workspace::set_state(const std::vector<double>& state) {
  if (state == state_) return;
  if (evaluated_ == state_.data()) evaluated_ = nullptr;
  if (derived_from_ == state_.data()) derived_from_ = nullptr;
  state_ = state;
}

void Workspace::store(const std::vector<double>& state) const {
  for (std::size_t p = 0; p < problem_->active().size(); ++p) {
    VertexPool& pool = *problem_->graph().vertex_pools()[p];
    for (const ActiveVertex& v : problem_->active()[p]) {
      if (v.tangent_offset < 0) continue;
      std::copy_n(state.begin() + v.state_offset, pool.state_size(v.index), pool.state(v.index));
    }
  }
}

void Workspace::apply_step() {
  for (std::size_t p = 0; p < problem_->active().size(); ++p) {
    problem_->graph().vertex_pools()[p]->oplus(problem_->active()[p], state_.data(), step_.data(),
                                               trial_.data());
  }
}

template <class Task>
void Workspace::for_each(int count, Task&& task) {
  if (threads_ != nullptr && problem_->chunks() > 1) {
    threads_->run(count, task);
  } else {
    for (int i = 0; i < count; ++i) task(i);
  }
}

/// Σ over the chunks of task(chunk, pool number), in their order.
template <class Task>
Cost Workspace::sum_chunks(Task&& task) {
  for_each(problem_->chunks(), [&](int chunk) {
    Cost sum;
    for (std::size_t p = 0; p < problem_->edges().size(); ++p) sum += task(chunk, p);
    chunk_costs_[chunk] = sum;
  });
  Cost total;
  for (const Cost& cost : chunk_costs_) total += cost;
  return total;
}

Cost Workspace::return_to_state() {
  if (evaluated_ == state_.data()) return evaluated_cost_;
  if (derived_from_ == state_.data()) return sum_costs(state_);
  return evaluate(state_);
}

Cost Workspace::evaluate(const std::vector<double>& state) {
  derive(state);
  return sum_costs(state);
}

void Workspace::derive(const std::vector<double>& state) {
  derived_from_ = state.data();
  const std::size_t chunks = problem_->chunks();
  for (std::size_t p = 0; p < derived_.size(); ++p) {
    if (!derived_[p]) continue;
    const std::vector<ActiveVertex>& active = problem_->active()[p];
    for_each(problem_->chunks(), [&](std::size_t chunk) {
      problem_->graph().vertex_pools()[p]->derive(active, active.size() * chunk / chunks,
                                                  active.size() * (chunk + 1) / chunks,
                                                  state.data(), *derived_[p]);
    });
  }
}

/// With the quantities derived of it.
Cost Workspace::sum_costs(const std::vector<double>& state) {
  evaluated_ = state.data();
  try {
    evaluated_cost_ = sum_chunks([&](int chunk, std::size_t p) {
      const CompiledEdges& edges = problem_->edges()[p];
      return problem_->graph().edge_pools()[p]->cost(
          edges, edges.chunk_begin[chunk], edges.chunk_begin[chunk + 1], evaluation(state, chunk));
    });
    return evaluated_cost_;
  } catch (const Error&) {
    throw_with_line(state);
    throw;
  }
}

/// The Error of an edge that cannot be evaluated, with the line that it was read from.
void Workspace::throw_with_line(const std::vector<double>& state) {
  const Graph& graph = problem_->graph();
  const auto line_of = [&graph](std::size_t pool, int index) {
    for (int slot = 0; slot < graph.edge_slots(); ++slot) {
      const Graph::EdgeRecord& record = graph.edge_record(slot);
      if (!graph.edge_alive(slot) || record.index != index) continue;
      if (record.pool == static_cast<int>(pool)) return record.line;
    }
    return 0;
  };
  Eigen::VectorXd e;
  for (std::size_t p = 0; p < problem_->edges().size(); ++p) {
    const CompiledEdges& edges = problem_->edges()[p];
    for (std::size_t k = 0; k < edges.edges.size(); ++k) {
      e.resize(graph.edge_pools()[p]->dimension(edges.edges[k]));
      try {
        graph.edge_pools()[p]->error(edges, static_cast<int>(k), evaluation(state, 0), e.data());
      } catch (const Error& error) {
        const int line = line_of(p, edges.edges[k]);
        if (line == 0 || error.line() > 0) throw;
        throw Error("", line, error.what(), "");
      }
    }
  }
}

Cost Workspace::linearise() {
  const auto zero = [&](std::vector<double>& values) {
    const std::size_t parts = problem_->chunks();
    for_each(problem_->chunks(), [&](std::size_t part) {
      std::fill(values.begin() + values.size() * part / parts,
                values.begin() + values.size() * (part + 1) / parts, 0.0);
    });
  };
  zero(hessian_);
  std::fill(gradient_.begin(), gradient_.end(), 0.0);
  const Cost total = sum_chunks([&](int chunk, std::size_t p) {
    const CompiledEdges& edges = problem_->edges()[p];
    return problem_->graph().edge_pools()[p]->linearise(
        edges, edges.chunk_begin[chunk], edges.chunk_begin[chunk + 1], evaluation(state_, chunk),
        hessian_.data(), gradient_.data());
  });
  reduce(problem_->hessian_reductions(), hessian_);
  reduce(problem_->gradient_reductions(), gradient_);
  return total;
}

/// Adds the sums that chunks kept aside.
void Workspace::reduce(const Problem::Reductions& reductions, std::vector<double>& values) {
  for_each(static_cast<int>(reductions.part_begin.size()) - 1, [&](int part) {
    for (int r = reductions.part_begin[part]; r < reductions.part_begin[part + 1]; ++r) {
      const Problem::Reduction& reduction = reductions.all[r];
      const double* from = values.data() + reduction.from;
      double* to = values.data() + reduction.to;
      for (int i = 0; i < reduction.size; ++i) to[i] += from[i];
    }
  });
}

void Workspace::error(int pool, int k, double* error) {
  problem_->graph().edge_pools()[pool]->error(problem_->edges()[pool], k, evaluation(state_, 0),
                                              error);
}

Workspace::Linearised Workspace::linearise_edge(int pool_number, int k) {
  EdgePool& pool = *problem_->graph().edge_pools()[pool_number];
  const CompiledEdges& compiled = problem_->edges()[pool_number];
  const int index = compiled.edges[k];
  const int first = compiled.constraint_row.empty() ? -1 : compiled.constraint_row[k];
  Linearised edge;
  edge.error.resize(pool.dimension(index));
  error(pool_number, k, edge.error.data());
  if (first >= 0) {
    constrain_error(constraint_rows_.data() + first, pool.dimension(index), edge.error.data());
  } else {
    edge.weight = pool.kernel(index).weights(weighted_square(pool, index, edge.error)).weight;
  }
  for (int s = compiled.slot_begin[k]; s < compiled.slot_begin[k + 1]; ++s) {
    edge.jacobians.emplace_back();
    if (compiled.slots[s].tangent_offset < 0) continue;
    Eigen::MatrixXd& jacobian = edge.jacobians.back();
    jacobian = pool.jacobian(compiled, k, s - compiled.slot_begin[k], evaluation(state_, 0), false);
    if (first >= 0) {
      constrain_jacobian(constraint_rows_.data() + first, static_cast<int>(jacobian.rows()),
                         static_cast<int>(jacobian.cols()), edge.error.data(), jacobian.data(),
                         false);
    }
    // A hinge that is not violated has no derivative.
    for (Eigen::Index r = 0; pool.one_sided() && r < edge.error.size(); ++r) {
      if (edge.error[r] == 0.0) jacobian.row(r).setZero();
    }
  }
  return edge;
}

void Workspace::diagonal(std::vector<double>& diagonal) const {
  const BlockPattern& pattern = problem_->pattern();
  for (int c = 0; c < pattern.size(); ++c) {
    const int n = pattern.dimension[c];
    const double* block = hessian_.data() + pattern.value_offset[pattern.column_begin[c + 1] - 1];
    for (int i = 0; i < n; ++i) diagonal[pattern.scalar_begin[c] + i] = block[i * n + i];
  }
}

double Workspace::quadratic_form(const std::vector<double>& x) const {
  const BlockPattern& pattern = problem_->pattern();
  double sum = 0.0;
  for (int c = 0; c < pattern.size(); ++c) {
    const double* xc = x.data() + pattern.scalar_begin[c];
    for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
      const int r = pattern.row[k], rows = pattern.dimension[r];
      const double* xr = x.data() + pattern.scalar_begin[r];
      const double* block = hessian_.data() + pattern.value_offset[k];
      double part = 0.0;
      for (int j = 0; j < pattern.dimension[c]; ++j) {
        for (int i = 0; i < rows; ++i) part += xr[i] * block[j * rows + i] * xc[j];
      }
      sum += r == c ? part : 2.0 * part;
    }
  }
  return sum;
}

}  // namespace locograph
