#include <locograph/core/graph.h>
#include <locograph/core/information.h>

#include <Eigen/Cholesky>
#include <cmath>

namespace locograph {
namespace {

/// [pool][index] → slot, grown on demand.
void set_slot(std::vector<std::vector<int>>& slots, int pool, int index, int slot) {
  if (static_cast<int>(slots.size()) <= pool) slots.resize(pool + 1);
  if (static_cast<int>(slots[pool].size()) <= index) slots[pool].resize(index + 1);
  slots[pool][index] = slot;
}

/// Clears a record and takes its object out of the pool, whose last one moves into the gap. slots:
/// of the pool's objects.
template <class Pool, class Record>
void remove_from_pool(Pool& pool, std::vector<int>& slots, std::vector<Record>& records,
                      Record& record) {
  const int moved = slots.back();
  pool.remove(record.index);
  records[moved].index = record.index;
  slots[record.index] = moved;
  slots.pop_back();
  record = {};
}

}  // namespace

int Graph::slot_of(int id) const {
  const auto found = slot_of_id_.find(id);
  return found == slot_of_id_.end() ? -1 : found->second;
}

int Graph::add_vertex_record(int id, int pool, int index) {
  const int slot = vertex_slots();
  if (!slot_of_id_.emplace(id, slot).second) {
    throw Error("vertex " + std::to_string(id) + " is declared twice", "an id used once");
  }
  VertexRecord record;
  record.id = id;
  record.pool = pool;
  record.index = index;
  vertex_records_.push_back(record);
  set_slot(vertex_slot_of_pool_index_, pool, index, slot);
  if (!incident_.empty()) incident_.emplace_back();
  ++vertex_count_;
  return slot;
}

int Graph::add_edge_record(int pool, int index, int line) {
  const int slot = edge_slots();
  edge_records_.push_back({pool, index, line, edge_pools_[pool]->constraint()});
  set_slot(edge_slot_of_pool_index_, pool, index, slot);
  if (!incident_.empty()) {
    for (const int v : edge_vertices(slot)) incident_[v].push_back(slot);
  }
  ++edge_count_;
  return slot;
}

void Graph::check_edge(std::span<const int> vertices) const {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (vertices[i] < 0 || vertices[i] >= vertex_slots() || !vertex_alive(vertices[i])) {
      throw Error("an edge names a vertex that is not in the graph");
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (vertices[i] == vertices[j]) {
        throw Error(
            "an edge names vertex " + std::to_string(vertex_records_[vertices[i]].id) + " twice",
            "different vertices");
      }
    }
  }
  if (vertices.empty()) throw Error("an edge has no vertex", "at least one");
}

void Graph::check_edge(std::span<const int> vertices,
                       const Eigen::Ref<const Eigen::VectorXd>& weights) const {
  check_edge(vertices);
  if (weights.size() == 0) throw Error("an edge without rows", "at least one weight");
  if (!weights.allFinite() || weights.minCoeff() < 0.0) {
    throw Error("a weight is negative or not finite", "weights >= 0");
  }
}

void Graph::check_edge(std::span<const int> vertices,
                       const Eigen::Ref<const Eigen::MatrixXd>& information, int dimension) const {
  check_edge(vertices);
  if (information.rows() != dimension || information.cols() != dimension) {
    throw Error("information matrix of size " + std::to_string(information.rows()) + " x " +
                    std::to_string(information.cols()),
                std::to_string(dimension) + " x " + std::to_string(dimension));
  }
  if (!information.allFinite()) throw Error("information matrix is not finite", "finite numbers");
  if (!is_symmetric(information)) {
    throw Error("information matrix is not symmetric", "a symmetric matrix");
  }
  if (!is_positive_semidefinite(information)) {
    throw Error("information matrix is indefinite", "a positive semi-definite matrix");
  }
}

int Graph::dimension(int slot) const {
  const VertexRecord& record = vertex_records_[slot];
  return vertex_pools_[record.pool]->dimension(record.index);
}
const double* Graph::state(int slot) const {
  const VertexRecord& record = vertex_records_[slot];
  return std::as_const(*vertex_pools_[record.pool]).state(record.index);
}
double* Graph::state(int slot) {
  const VertexRecord& record = vertex_records_[slot];
  return vertex_pools_[record.pool]->state(record.index);
}
int Graph::state_size(int slot) const {
  const VertexRecord& record = vertex_records_[slot];
  return vertex_pools_[record.pool]->state_size(record.index);
}

void Graph::replace_parameter(int number, std::shared_ptr<const Parameter> parameter) {
  parameters_.replace(number, std::move(parameter));
  for (const auto& pool : edge_pools_) {
    for (int i = 0; i < pool->size(); ++i) pool->bind(i, parameters_);
  }
}

const std::string& Graph::vertex_tag(int slot) const {
  const VertexRecord& record = vertex_records_[slot];
  return record.alias >= 0 ? aliases_[record.alias] : vertex_pools_[record.pool]->tag();
}

std::span<const int> Graph::edge_vertices(int slot) const {
  const EdgeRecord& record = edge_records_[slot];
  return std::as_const(*edge_pools_[record.pool]).vertices(record.index);
}

const std::vector<int>& Graph::incident_edges(int vertex_slot) const {
  if (incident_.empty()) {
    incident_.resize(vertex_slots());
    for (int e = 0; e < edge_slots(); ++e) {
      if (!edge_alive(e)) continue;
      for (const int v : edge_vertices(e)) incident_[v].push_back(e);
    }
  }
  return incident_[vertex_slot];
}

void Graph::set_kernel(const RobustKernel& kernel) {
  for (const std::unique_ptr<EdgePool>& pool : edge_pools_) {
    for (int i = 0; i < pool->size(); ++i) pool->kernel(i) = kernel;
  }
}

void Graph::remove_edge(EdgeId e) {
  EdgeRecord& record = edge_records_[e.slot];
  if (!incident_.empty()) {
    for (const int v : edge_vertices(e.slot)) std::erase(incident_[v], e.slot);
  }
  remove_from_pool(*edge_pools_[record.pool], edge_slot_of_pool_index_[record.pool], edge_records_,
                   record);
  --edge_count_;
}

EdgeId Graph::add_dense_prior(DensePrior prior) {
  check_edge(prior.vertices, prior.information, static_cast<int>(prior.offset.size()));
  int number = 0;
  while (number < static_cast<int>(edge_pools_.size()) &&
         edge_pools_[number]->type() != typeid(DensePrior)) {
    ++number;
  }
  if (number == static_cast<int>(edge_pools_.size())) {
    edge_pools_.push_back(std::make_unique<DensePriorPool>());
  }
  DensePriorPool& pool = static_cast<DensePriorPool&>(*edge_pools_[number]);
  pool.edges.push_back(std::move(prior));
  try {
    pool.check(pool.size() - 1, *this);
  } catch (const Error&) {
    pool.edges.pop_back();
    throw;
  }
  return {add_edge_record(number, pool.size() - 1, 0)};
}

void Graph::check_constraint(const EdgePool& pool, int index, ConstraintKind kind) {
  if (kind == ConstraintKind::kNone || pool.has_weights()) return;
  const Eigen::MatrixXd information = pool.information(index);
  const bool diagonal = information.isDiagonal(0.0);
  if (kind == ConstraintKind::kInequality && !diagonal) {
    throw Error("an inequality with an information matrix that is not diagonal", "a diagonal one");
  }
  if (kind == ConstraintKind::kEquality && !diagonal &&
      information.llt().info() != Eigen::Success) {
    throw Error("a constraint with a singular information matrix", "a positive definite one");
  }
}

void Graph::set_constraint(EdgeId e, ConstraintKind kind, double tolerance) {
  if (!(tolerance >= 0.0 && std::isfinite(tolerance))) {
    throw Error("a tolerance of " + std::to_string(tolerance), "0 (the type's own) or more");
  }
  EdgeRecord& record = edge_records_[e.slot];
  check_constraint(*edge_pools_[record.pool], record.index, kind);
  record.constraint = kind;
  record.tolerance = tolerance;
}

void Graph::remove_vertex(int slot) {
  const std::vector<int> edges = incident_edges(slot);
  for (const int e : edges) remove_edge({e});
  VertexRecord& record = vertex_records_[slot];
  slot_of_id_.erase(record.id);
  remove_from_pool(*vertex_pools_[record.pool], vertex_slot_of_pool_index_[record.pool],
                   vertex_records_, record);
  --vertex_count_;
}

}  // namespace locograph
