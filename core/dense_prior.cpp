#include <locograph/core/dense_prior.h>
#include <locograph/core/graph.h>

#include <algorithm>

namespace locograph {
namespace {

std::span<const CompiledEdges::Slot> slots_of(const CompiledEdges& compiled, int k) {
  const int begin = compiled.slot_begin[k];
  return {compiled.slots.data() + begin,
          static_cast<std::size_t>(compiled.slot_begin[k + 1] - begin)};
}
int dimension_of(const CompiledEdges::Slot& slot) {
  return slot.pool->dimension(slot.vertex_index);
}
int state_size_of(const CompiledEdges::Slot& slot) {
  return slot.pool->state_size(slot.vertex_index);
}
const ConstraintRow* constraint_rows(const CompiledEdges& compiled, int k, const Evaluation& x) {
  if (compiled.constraint_row.empty() || compiled.constraint_row[k] < 0) return nullptr;
  if (x.constraint_rows == nullptr) return nullptr;
  return x.constraint_rows + compiled.constraint_row[k];
}

}  // namespace

std::size_t DensePriorPool::scratch_bytes(const CompiledEdges& compiled) const {
  std::size_t most = 0;
  for (std::size_t k = 0; k < compiled.edges.size(); ++k) {
    const std::size_t n = static_cast<std::size_t>(dimension(compiled.edges[k]));
    const std::span<const CompiledEdges::Slot> slots = slots_of(compiled, static_cast<int>(k));
    std::size_t doubles = 3 * n, bytes = slots.size() * sizeof(double*), difference = 0, widest = 0;
    for (const CompiledEdges::Slot& slot : slots) {
      const std::size_t d = static_cast<std::size_t>(dimension_of(slot));
      doubles += d * d;
      widest = std::max(widest, d);
      difference = std::max(difference, slot.pool->ominus_scratch_bytes(slot.vertex_index));
    }
    doubles += 2 * widest * widest + widest;
    bytes += doubles * sizeof(double) + 2 * difference + (slots.size() + 16) * Scratch::kAlignment;
    most = std::max(most, bytes);
  }
  return most;
}

void DensePriorPool::error(const CompiledEdges& compiled, int k, const Evaluation& x,
                           double* error) const {
  const DensePrior& edge = edges[compiled.edges[k]];
  const double* reference = edge.states.data();
  double* e = error;
  for (const CompiledEdges::Slot& slot : slots_of(compiled, k)) {
    slot.pool->ominus(slot.vertex_index, x.state + slot.state_offset, reference, e, *x.scratch);
    reference += state_size_of(slot);
    e += dimension_of(slot);
  }
  Vector(error, edge.offset.size()) += edge.offset;
}

DensePriorPool::Vector DensePriorPool::shifted_error(const CompiledEdges& compiled, int k,
                                                     const Evaluation& x) const {
  const int n = dimension(compiled.edges[k]);
  Vector e(x.scratch->array<double>(n), n);
  error(compiled, k, x, e.data());
  const ConstraintRow* rows = constraint_rows(compiled, k, x);
  if (rows != nullptr) {
    std::copy_n(e.data(), n, x.constraint_errors + compiled.constraint_row[k]);
    constrain_error(rows, compiled.one_sided[k] != 0, n, e.data());
  }
  return e;
}

Cost DensePriorPool::cost(const CompiledEdges& compiled, int begin, int end,
                          const Evaluation& x) const {
  Cost total;
  for (int k = begin; k < end; ++k) {
    x.scratch->reset();
    const DensePrior& edge = edges[compiled.edges[k]];
    const Vector e = shifted_error(compiled, k, x);
    Vector weighted(x.scratch->array<double>(e.size()), e.size());
    weighted.noalias() = edge.information * e;
    const double chi2 = e.dot(weighted);
    const bool constraint = constraint_rows(compiled, k, x) != nullptr;
    total += {constraint ? chi2 : edge.kernel.weights(chi2).cost, chi2};
  }
  return total;
}

Cost DensePriorPool::linearise(const CompiledEdges& compiled, int begin, int end,
                               const Evaluation& x, double* hessian, double* gradient) const {
  Cost total;
  for (int k = begin; k < end; ++k) {
    x.scratch->reset();
    total += linearise_one(compiled, k, x, hessian, gradient);
  }
  return total;
}

/// The Jacobian is block-diagonal: H_ij += J_iᵀ wΩ_ij J_j, g_i += J_iᵀ (wΩe)_i.
Cost DensePriorPool::linearise_one(const CompiledEdges& compiled, int k, const Evaluation& x,
                                   double* hessian, double* gradient) const {
  const DensePrior& edge = edges[compiled.edges[k]];
  const std::span<const CompiledEdges::Slot> slots = slots_of(compiled, k);
  const ConstraintRow* rows = constraint_rows(compiled, k, x);
  const Vector e = shifted_error(compiled, k, x);
  Vector force(x.scratch->array<double>(e.size()), e.size());
  force.noalias() = edge.information * e;
  const double chi2 = e.dot(force);
  const RobustKernel::Weights robust =
      rows == nullptr ? edge.kernel.weights(chi2) : RobustKernel::Weights{chi2, 1.0};

  using Matrix = Eigen::Map<Eigen::MatrixXd>;
  double** jacobians = x.scratch->array<double*>(slots.size());
  const double* reference = edge.states.data();
  Eigen::Index widest = 0;
  for (std::size_t s = 0, row = 0; s < slots.size(); ++s) {
    const Eigen::Index d = dimension_of(slots[s]);
    widest = std::max(widest, d);
    jacobians[s] = nullptr;
    if (slots[s].tangent_offset >= 0) {
      jacobians[s] = x.scratch->array<double>(static_cast<std::size_t>(d * d));
      slots[s].pool->ominus_jacobian(slots[s].vertex_index, x.state + slots[s].state_offset,
                                     reference, jacobians[s], *x.scratch);
      if (rows != nullptr) {
        constrain_jacobian(rows + row, compiled.one_sided[k] != 0, static_cast<int>(d),
                           static_cast<int>(d), e.data() + row, jacobians[s], false);
      }
    }
    reference += state_size_of(slots[s]);
    row += static_cast<std::size_t>(d);
  }
  const std::size_t square = static_cast<std::size_t>(widest * widest);
  double* left_data = x.scratch->array<double>(square);
  // Second-order kernels bend Ω: w(Ω + β Ωe(Ωe)ᵀ).
  const double bend = rows == nullptr ? edge.kernel.correction(chi2, robust) : 0.0;
  Vector bent(x.scratch->array<double>(static_cast<std::size_t>(widest)), widest);
  const CompiledEdges::Block* block = compiled.blocks.data() + compiled.block_begin[k];
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    const Eigen::Index di = dimension_of(slots[i]);
    if (jacobians[i] != nullptr) {
      const Matrix ji(jacobians[i], di, di);
      Vector(gradient + slots[i].gradient_offset, di).noalias() +=
          robust.weight * ji.transpose().lazyProduct(force.segment(row, di));
    }
    Eigen::Index column = row;
    for (std::size_t j = i; j < slots.size(); ++j, ++block) {
      const Eigen::Index dj = dimension_of(slots[j]);
      if (jacobians[i] != nullptr && jacobians[j] != nullptr) {
        const Matrix ji(jacobians[i], di, di), jj(jacobians[j], dj, dj);
        Matrix left(left_data, di, dj);
        left.noalias() =
            robust.weight * ji.transpose().lazyProduct(edge.information.block(row, column, di, dj));
        if (bend != 0.0) {
          bent.head(di).noalias() = ji.transpose().lazyProduct(force.segment(row, di));
          left.noalias() += (robust.weight * bend) *
                            bent.head(di).lazyProduct(force.segment(column, dj).transpose());
        }
        if ((*block & 1) == 0) {
          Matrix(hessian + (*block >> 1), di, dj).noalias() += left.lazyProduct(jj);
        } else {
          Matrix(hessian + (*block >> 1), dj, di).noalias() +=
              jj.transpose().lazyProduct(left.transpose());
        }
      }
      column += dj;
    }
    row += di;
  }
  return {robust.cost, chi2};
}

Eigen::MatrixXd DensePriorPool::jacobian(const CompiledEdges& compiled, int k, int slot,
                                         const Evaluation& x, bool numeric) const {
  x.scratch->reset();
  const std::span<const CompiledEdges::Slot> slots = slots_of(compiled, k);
  const int n = dimension(compiled.edges[k]);
  const double* reference = edges[compiled.edges[k]].states.data();
  int row = 0;
  for (int s = 0; s < slot; ++s) {
    reference += state_size_of(slots[s]);
    row += dimension_of(slots[s]);
  }
  const CompiledEdges::Slot& own = slots[slot];
  const int d = dimension_of(own);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, d);
  if (!numeric) {
    Eigen::MatrixXd part(d, d);
    own.pool->ominus_jacobian(own.vertex_index, x.state + own.state_offset, reference, part.data(),
                              *x.scratch);
    result.middleRows(row, d) = part;
    return result;
  }
  constexpr double kStep = 1e-5;
  const ActiveVertex vertex{own.vertex_index, 0, 0};
  Eigen::VectorXd step = Eigen::VectorXd::Zero(d), moved(state_size_of(own)), plus(d), minus(d);
  for (int c = 0; c < d; ++c) {
    for (const double sign : {1.0, -1.0}) {
      step[c] = sign * kStep;
      own.pool->oplus({&vertex, 1}, x.state + own.state_offset, step.data(), moved.data());
      own.pool->ominus(own.vertex_index, moved.data(), reference,
                       sign > 0.0 ? plus.data() : minus.data(), *x.scratch);
    }
    step[c] = 0.0;
    result.col(c).segment(row, d) = (plus - minus) / (2.0 * kStep);
  }
  return result;
}

int DensePriorPool::read(std::span<const int> vertices, FieldReader& in) {
  const int n = in.integer();
  // A digit and a blank for each number of Ω: do not reserve memory for what cannot follow.
  if (n < 1 || 1.0 * n * (n + 1) > 1.0 * in.characters_left() + 1.0) {
    in.fail("a prior of size " + std::to_string(n), "the sum of its vertices' dimensions");
  }
  std::vector<double> numbers;
  while (!in.at_end()) numbers.push_back(in.number());
  const std::size_t size = static_cast<std::size_t>(n), rest = size + size * (size + 1) / 2;
  if (numbers.size() <= rest) in.fail("too few fields", "states, offset and information");
  DensePrior edge;
  edge.vertices.assign(vertices.begin(), vertices.end());
  const std::size_t states = numbers.size() - rest;
  edge.states.assign(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(states));
  edge.offset = Eigen::Map<const Eigen::VectorXd>(numbers.data() + states, n);
  edge.information.resize(n, n);
  const double* next = numbers.data() + states + size;
  for (int r = 0; r < n; ++r) {
    for (int c = r; c < n; ++c) edge.information(r, c) = edge.information(c, r) = *next++;
  }
  edges.push_back(std::move(edge));
  return this->size() - 1;
}

void DensePriorPool::check(int index, const Graph& graph) const {
  const DensePrior& edge = edges[index];
  std::size_t states = 0;
  int dimension = 0;
  for (const int v : edge.vertices) {
    states += static_cast<std::size_t>(graph.state_size(v));
    dimension += graph.dimension(v);
  }
  if (dimension != edge.offset.size() || edge.information.rows() != dimension ||
      edge.information.cols() != dimension) {
    throw Error("a prior of size " + std::to_string(edge.offset.size()),
                "the sum of its vertices' dimensions, " + std::to_string(dimension));
  }
  if (states != edge.states.size()) {
    throw Error("a prior with " + std::to_string(edge.states.size()) + " numbers of state",
                "the states of its vertices, " + std::to_string(states));
  }
}

void DensePriorPool::write(int index, FieldWriter& out) const {
  const DensePrior& edge = edges[index];
  out.integer(edge.offset.size());
  for (const double s : edge.states) out.number(s);
  for (const double o : edge.offset) out.number(o);
  for (Eigen::Index r = 0; r < edge.offset.size(); ++r) {
    for (Eigen::Index c = r; c < edge.offset.size(); ++c) out.number(edge.information(r, c));
  }
}

void DensePriorPool::remove(int index) {
  if (index + 1 != size()) edges[index] = std::move(edges.back());
  edges.pop_back();
}

}  // namespace locograph
