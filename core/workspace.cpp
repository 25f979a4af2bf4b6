#include <locograph/core/row_kernels.h>
#include <locograph/core/weighted_square.h>
#include <locograph/core/workspace.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace locograph {

void Workspace::allocate(const Problem& problem) {
  row_kernels();  // chosen before anything is evaluated, for choosing allocates
  problem_ = &problem;
  bindings_.clear();
  state_.resize(problem.state_size());
  trial_.resize(problem.state_size());
  hessian_.resize(problem.hessian_reductions().size);
  const int n = problem.dimension();
  gradient_.resize(problem.gradient_reductions().size);
  step_.resize(n);
  damping_.assign(n, 0.0);
  if (!std::exchange(rows_as_allocated_, true)) constraint_rows_.clear();
  constraint_rows_.resize(problem.constraint_rows());
  constraint_errors_.resize(problem.constraint_rows());
  evaluated_ = derived_from_ = summed_ = partly_ = nullptr;
  const std::size_t pools = problem.active().size();
  // Types may have been registered since.
  kept_.valid =
      kept_.valid && kept_.active.size() == pools && kept_.edges.size() == problem.edges().size();
  for (std::size_t p = 0; kept_.valid && p < pools; ++p) {
    kept_.valid =
        derived_[p] == nullptr || derived_for_[p].is_of(*problem.graph().vertex_pools()[p]);
  }
  derived_.resize(pools);
  derived_for_.resize(pools);
  for (std::size_t p = 0; p < pools; ++p) {
    const VertexPool& pool = *problem.graph().vertex_pools()[p];
    const std::vector<ActiveVertex>& active = problem.active()[p];
    if (derived_[p] && kept_.valid && derived_for_[p].is_of(pool)) continue;  // see take_over()
    // A store whose places have the same sizes serves a window that slid or got shorter.
    if (derived_[p] && derived_for_[p].fits(pool, active)) continue;
    derived_[p] = pool.make_derived(active);
    if (derived_[p]) derived_for_[p].assign(pool, active);
  }
  if (static_cast<int>(scratch_.size()) < problem.chunks()) scratch_.resize(problem.chunks());
  for (Scratch& scratch : scratch_) scratch.reserve(problem.scratch_bytes());
  chunk_costs_.resize(problem.chunks());
  by_edge_ = keeps_;
  if (!by_edge_) return;
  edge_costs_.resize(problem.edges().size());
  for (std::size_t p = 0; p < edge_costs_.size(); ++p) {
    edge_costs_[p].resize(problem.edges()[p].edges.size());
  }
  // Written to now rather than when rows are kept first, which may be in a cycle that has no time.
  if (kept_.rows.capacity() < constraint_rows_.size()) {
    const std::size_t rows = kept_.rows.size();
    kept_.rows.resize(constraint_rows_.size());
    kept_.rows.resize(rows);
  }
}

void Workspace::keep() {
  keeps_ = true;
  kept_.valid =
      by_edge_ && summed_ == state_.data() && derived_from_ == state_.data() && !rows_changed_;
  kept_.world = evaluated_ == state_.data();
  evaluated_ = summed_ = derived_from_ = partly_ = nullptr;
  if (!kept_.valid) return;
  kept_.bindings = bindings_;
  kept_.active.resize(problem_->active().size());
  std::ranges::copy(problem_->active(), kept_.active.begin());
  kept_.state = state_;
  kept_.errors.swap(constraint_errors_);
  kept_.rows.clear();
  if (!rows_as_allocated_) kept_.rows = constraint_rows_;
  const std::size_t pools = problem_->edges().size();
  kept_.edges.resize(pools);
  kept_.constraint_row.resize(pools);
  for (std::size_t p = 0; p < pools; ++p) {
    kept_.edges[p] = problem_->edges()[p].edges;
    kept_.constraint_row[p] = problem_->edges()[p].constraint_row;
  }
  kept_.costs.swap(edge_costs_);
}

void Workspace::take_over() {
  if (!std::exchange(kept_.valid, false)) return;
  known_vertices_.resize(derived_.size());
  for (std::size_t p = 0; p < derived_.size(); ++p) take_over_vertices(p);
  known_edges_.resize(kept_.edges.size());
  const bool same_bindings = kept_.world && kept_.bindings == bindings_;
  for (std::size_t p = 0; p < kept_.edges.size(); ++p) take_over_edges(p, same_bindings);
  partly_ = state_.data();
}

void Workspace::take_over_vertices(std::size_t p) {
  const VertexPool& pool = *problem_->graph().vertex_pools()[p];
  const std::vector<ActiveVertex>&active = problem_->active()[p], &was = kept_.active[p];
  std::vector<char>& known = known_vertices_[p];
  known.assign(active.size(), 0);
  place_.clear();
  for (std::size_t i = 0; i < was.size(); ++i) place_.emplace_back(was[i].index, i);
  std::ranges::sort(place_);
  from_.assign(active.size(), -1);
  for (std::size_t i = 0; i < active.size(); ++i) {
    const auto found = std::ranges::lower_bound(place_, std::pair(active[i].index, 0));
    if (found == place_.end() || found->first != active[i].index) continue;
    const ActiveVertex& before = was[static_cast<std::size_t>(found->second)];
    const double* now = state_.data() + active[i].state_offset;
    const int size = pool.state_size(active[i].index);
    // To the bit: -0 and 0 may have other quantities.
    if (std::memcmp(now, kept_.state.data() + before.state_offset, size * sizeof(double)) != 0)
      continue;
    known[i] = 1;
    from_[i] = found->second;
  }
  if (derived_[p] == nullptr) return;
  DerivedStore& store = *derived_[p];
  std::vector<int>& sizes = derived_for_[p].state_sizes;
  const auto make = [&](std::size_t i) {
    pool.make_derived_at(active, i, store);
    sizes.resize(static_cast<std::size_t>(store.size()));
    sizes[i] = pool.state_size(active[i].index);
  };
  while (store.size() < static_cast<int>(active.size())) make(store.size());
  from_.resize(static_cast<std::size_t>(store.size()), -1);
  used_.assign(from_.size(), 0);
  for (const int i : from_) {
    if (i >= 0) used_[static_cast<std::size_t>(i)] = 1;
  }
  int unused = 0;
  for (int& i : from_) {
    if (i >= 0) continue;
    while (used_[static_cast<std::size_t>(unused)] != 0) ++unused;
    i = unused++;
  }
  sizes_.clear();
  for (const int i : from_) sizes_.push_back(sizes[static_cast<std::size_t>(i)]);
  sizes.swap(sizes_);
  store.arrange(from_);
  for (std::size_t i = 0; i < active.size(); ++i) {
    if (sizes[i] != pool.state_size(active[i].index)) make(i);
  }
}

void Workspace::take_over_edges(std::size_t p, bool same_bindings) {
  const EdgePool& pool = *problem_->graph().edge_pools()[p];
  const CompiledEdges& edges = problem_->edges()[p];
  std::vector<char>& known = known_edges_[p];
  known.assign(edges.edges.size(), 0);
  if (pool.reads_bindings() && !same_bindings) return;
  const std::vector<int>& was = kept_.edges[p];
  // Both mostly ascend; what is missed for that is evaluated.
  std::size_t old = 0;
  for (std::size_t k = 0; k < edges.edges.size(); ++k) {
    while (old < was.size() && was[old] < edges.edges[k]) ++old;
    if (old == was.size()) break;
    if (was[old] != edges.edges[k]) continue;
    const auto slots =
        std::span(edges.slots)
            .subspan(edges.slot_begin[k], edges.slot_begin[k + 1] - edges.slot_begin[k]);
    if (!std::ranges::all_of(slots, [&](const CompiledEdges::Slot& slot) {
          return known_vertices_[slot.pool_number][slot.derived_index] != 0;
        })) {
      continue;
    }
    const int row = edges.constraint_row.empty() ? -1 : edges.constraint_row[k];
    const int row_was = kept_.constraint_row[p].empty() ? -1 : kept_.constraint_row[p][old];
    if ((row < 0) != (row_was < 0)) continue;
    if (row >= 0) {
      const int count = pool.dimension(edges.edges[k]);
      bool same = true;
      for (int r = 0; r < count && same && !(kept_.rows.empty() && rows_as_allocated_); ++r) {
        const ConstraintRow before = kept_.rows.empty() ? ConstraintRow() : kept_.rows[row_was + r];
        same = before == constraint_rows_[row + r];
      }
      if (!same) continue;
      std::copy_n(kept_.errors.begin() + row_was, count, constraint_errors_.begin() + row);
    }
    edge_costs_[p][k] = kept_.costs[p][old];
    known[k] = 1;
  }
}

bool Workspace::DerivedFor::fits(const VertexPool& other,
                                 std::span<const ActiveVertex> active) const {
  return is_of(other) && active.size() <= state_sizes.size() &&
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
  evaluated_ = partly_ = nullptr;
  bindings_changed_ = true;
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
  evaluated_ = derived_from_ = summed_ = partly_ = nullptr;
  take_over();
}

void Workspace::set_state(const std::vector<double>& state) {
  if (state == state_) return;
  if (evaluated_ == state_.data()) evaluated_ = nullptr;
  if (derived_from_ == state_.data()) derived_from_ = nullptr;
  if (summed_ == state_.data()) summed_ = nullptr;
  if (partly_ == state_.data()) partly_ = nullptr;
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
  if (derived_from_ == state_.data()) {
    return sum_costs(state_, summed_ == state_.data() ? Stale::kChanged : Stale::kAll);
  }
  return evaluate(state_);
}

Cost Workspace::evaluate(const std::vector<double>& state) {
  const bool partly = partly_ == state.data();
  derive(state);
  partly_ = nullptr;
  return sum_costs(state, partly ? Stale::kUnknown : Stale::kAll);
}

void Workspace::derive(const std::vector<double>& state) {
  derived_from_ = state.data();
  const std::size_t chunks = problem_->chunks();
  for (std::size_t p = 0; p < derived_.size(); ++p) {
    if (!derived_[p]) continue;
    const std::vector<ActiveVertex>& active = problem_->active()[p];
    const VertexPool& pool = *problem_->graph().vertex_pools()[p];
    if (partly_ == state.data()) {
      const std::vector<char>& known = known_vertices_[p];
      for (std::size_t i = 0, end = 0; i < active.size(); i = end + 1) {
        for (end = i; end < active.size() && known[end] == 0;) ++end;
        pool.derive(active, i, end, state.data(), *derived_[p]);
      }
      continue;
    }
    for_each(problem_->chunks(), [&](std::size_t chunk) {
      pool.derive(active, active.size() * chunk / chunks, active.size() * (chunk + 1) / chunks,
                  state.data(), *derived_[p]);
    });
  }
}

/// With the quantities derived of it.
Cost Workspace::sum_costs(const std::vector<double>& state, Stale stale) {
  evaluated_ = summed_ = nullptr;
  try {
    evaluated_cost_ = sum_chunks([&](int chunk, std::size_t p) {
      const CompiledEdges& edges = problem_->edges()[p];
      const EdgePool& pool = *problem_->graph().edge_pools()[p];
      const int begin = edges.chunk_begin[chunk], end = edges.chunk_begin[chunk + 1];
      if (!by_edge_) return pool.cost(edges, begin, end, evaluation(state, chunk));
      const bool all = stale == Stale::kAll ||
                       (stale == Stale::kChanged && bindings_changed_ && pool.reads_bindings());
      const bool by_rows = stale == Stale::kChanged && rows_changed_ && !all;
      Evaluation x = evaluation(state, chunk);
      x.errors_known = by_rows;
      Cost sum;
      for (int k = begin; k < end; ++k) {
        Cost& cost = edge_costs_[p][k];
        const bool constrains = !edges.constraint_row.empty() && edges.constraint_row[k] >= 0;
        if (all || (by_rows && constrains) ||
            (stale == Stale::kUnknown && known_edges_[p][k] == 0)) {
          cost = pool.cost(edges, k, k + 1, x);
        }
        sum += cost;
      }
      return sum;
    });
    evaluated_ = summed_ = state.data();
    bindings_changed_ = rows_changed_ = false;
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
    constrain_error(constraint_rows_.data() + first, compiled.one_sided[k] != 0,
                    pool.dimension(index), edge.error.data());
  } else {
    edge.weight = pool.kernel(index).weights(weighted_square(pool, index, edge.error)).weight;
  }
  for (int s = compiled.slot_begin[k]; s < compiled.slot_begin[k + 1]; ++s) {
    edge.jacobians.emplace_back();
    if (compiled.slots[s].tangent_offset < 0) continue;
    Eigen::MatrixXd& jacobian = edge.jacobians.back();
    jacobian = pool.jacobian(compiled, k, s - compiled.slot_begin[k], evaluation(state_, 0), false);
    if (first >= 0) {
      constrain_jacobian(constraint_rows_.data() + first, compiled.one_sided[k] != 0,
                         static_cast<int>(jacobian.rows()), static_cast<int>(jacobian.cols()),
                         edge.error.data(), jacobian.data(), false);
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
