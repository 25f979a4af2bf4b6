#include <locograph/core/workspace.h>

#include <algorithm>

namespace locograph {

void Workspace::allocate(const Problem& problem) {
  problem_ = &problem;
  state_.resize(problem.state_size());
  trial_.resize(problem.state_size());
  hessian_.resize(problem.pattern().values());
  const int n = problem.dimension();
  gradient_.resize(n);
  step_.resize(n);
  damping_.assign(n, 0.0);
  const std::size_t pools = problem.active().size();
  derived_.resize(pools);
  derived_for_.resize(pools);
  for (std::size_t p = 0; p < pools; ++p) {
    const VertexPool& pool = *problem.graph().vertex_pools()[p];
    const std::vector<ActiveVertex>& active = problem.active()[p];
    // A store whose places have the same sizes serves a window that slid.
    if (derived_[p] && derived_for_[p].fits(pool, active)) continue;
    derived_[p] = pool.make_derived(active);
    if (derived_[p]) derived_for_[p].assign(pool, active);
  }
  scratch_.reserve(problem.scratch_bytes());
}

bool Workspace::DerivedFor::fits(const VertexPool& other,
                                 std::span<const ActiveVertex> active) const {
  if (pool != &other || type != other.type()) return false;
  return std::equal(
      active.begin(), active.end(), state_sizes.begin(), state_sizes.end(),
      [&](const ActiveVertex& v, int size) { return other.state_size(v.index) == size; });
}

void Workspace::DerivedFor::assign(const VertexPool& other, std::span<const ActiveVertex> active) {
  pool = &other;
  type = other.type();
  state_sizes.clear();
  for (const ActiveVertex& v : active) state_sizes.push_back(other.state_size(v.index));
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
}

void Workspace::store_state() const {
  for (std::size_t p = 0; p < problem_->active().size(); ++p) {
    VertexPool& pool = *problem_->graph().vertex_pools()[p];
    for (const ActiveVertex& v : problem_->active()[p]) {
      if (v.tangent_offset < 0) continue;
      std::copy_n(state_.begin() + v.state_offset, pool.state_size(v.index), pool.state(v.index));
    }
  }
}

void Workspace::apply_step() {
  for (std::size_t p = 0; p < problem_->active().size(); ++p) {
    problem_->graph().vertex_pools()[p]->oplus(problem_->active()[p], state_.data(), step_.data(),
                                               trial_.data());
  }
}

Cost Workspace::evaluate(const std::vector<double>& state) {
  for (std::size_t p = 0; p < derived_.size(); ++p) {
    if (!derived_[p]) continue;
    problem_->graph().vertex_pools()[p]->derive(problem_->active()[p], state.data(), *derived_[p]);
  }
  Cost total;
  const Evaluation x = evaluation(state);
  for (std::size_t p = 0; p < problem_->edges().size(); ++p) {
    total += problem_->graph().edge_pools()[p]->cost(problem_->edges()[p], x);
  }
  return total;
}

Cost Workspace::linearise() {
  std::fill(hessian_.begin(), hessian_.end(), 0.0);
  std::fill(gradient_.begin(), gradient_.end(), 0.0);
  Cost total;
  const Evaluation x = evaluation(state_);
  for (std::size_t p = 0; p < problem_->edges().size(); ++p) {
    total += problem_->graph().edge_pools()[p]->linearise(problem_->edges()[p], x, hessian_.data(),
                                                          gradient_.data());
  }
  return total;
}

void Workspace::error(int pool, int k, double* error) {
  problem_->graph().edge_pools()[pool]->error(problem_->edges()[pool], k, evaluation(state_),
                                              error);
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
