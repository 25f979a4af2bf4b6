#pragma once
/// The hyper-graph a user edits: vertices and edges by value, one contiguous pool for each type.
///
///     Graph graph;
///     VertexId<VertexSE2> a = graph.add_vertex(0, VertexSE2());
///     VertexId<VertexSE2> b = graph.add_vertex(1, VertexSE2());
///     EdgeSE2 edge;
///     edge.measurement = SE2<double>(1.0, 0.0, 0.1);
///     EdgeId e = graph.add_edge(edge, a, b);
///     graph.set_fixed(a, true);
///     graph.vertex(b).state;                      // by value, in its pool
///
/// A vertex has an id of the user's choice (the number in a file) and a slot, which is what edges
/// and VertexId hold: slots never move while the vertex lives. Removing keeps pools contiguous.
/// Not thread-safe while edited; const access is.

#include <locograph/core/dense_prior.h>
#include <locograph/core/edge_pool.h>
#include <locograph/core/parameters.h>
#include <locograph/core/typed_edge_pool.h>
#include <locograph/core/vertex_pool.h>

#include <memory>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace locograph {

/// An edge's handle: never moves while the edge lives.
struct EdgeId {
  int slot = -1;
  bool operator==(const EdgeId&) const = default;
};

class Graph {
 public:
  struct VertexRecord {
    int id = 0;
    int pool = -1;  ///< -1: removed
    int index = 0;
    bool fixed = false;
    bool eliminate = false;  ///< by a Schur complement
    int line = 0;            ///< in the file it came from, 0 otherwise
    int alias = -1;          ///< which alias of its type's tag the file used, -1 for the tag itself
  };
  struct EdgeRecord {
    int pool = -1;  ///< -1: removed
    int index = 0;
    int line = 0;
    ConstraintKind constraint = ConstraintKind::kNone;  ///< its type's, unless set
    double tolerance = 0.0;  ///< of its rows; 0: as its type says (edge.h)
  };

  Graph() = default;
  Graph(Graph&&) = default;
  Graph& operator=(Graph&&) = default;

  // Vertices ------------------------------------------------------------------------------------

  /// Throws Error when the id is taken.
  template <class V>
  VertexId<V> add_vertex(int id, V vertex) {
    const int pool = vertex_pool_of<V>();
    std::vector<V>& vertices = static_cast<TypedVertexPool<V>&>(*vertex_pools_[pool]).vertices;
    const int slot = add_vertex_record(id, pool, static_cast<int>(vertices.size()));
    vertices.push_back(std::move(vertex));
    return {slot};
  }
  template <class V>
  V& vertex(VertexId<V> v) {
    return typed_vertex<V>(v.slot);
  }
  template <class V>
  const V& vertex(VertexId<V> v) const {
    return const_cast<Graph*>(this)->typed_vertex<V>(v.slot);
  }
  /// Throws Error when there is no such id, or when it is of another type.
  template <class V>
  VertexId<V> find(int id) const {
    const int slot = slot_of(id);
    if (slot < 0 || vertex_pools_[vertex_records_[slot].pool]->type() != typeid(V)) {
      throw Error("no vertex " + std::to_string(id) + " of the type asked for");
    }
    return {slot};
  }
  /// -1 when there is no such id.
  int slot_of(int id) const;
  template <class V>
  void set_fixed(VertexId<V> v, bool fixed) {
    set_fixed(v.slot, fixed);
  }
  void set_fixed(int slot, bool fixed) { vertex_records_[slot].fixed = fixed; }
  /// Marks vertices (landmarks, contact wrenches) that a Schur complement eliminates first. No edge
  /// between two marked vertices may exist when the Schur solver is used.
  void set_eliminate(int slot, bool eliminate) { vertex_records_[slot].eliminate = eliminate; }
  /// Removes a vertex and every edge on it.
  void remove_vertex(int slot);

  int vertex_count() const { return vertex_count_; }
  /// Number of slots, also those of removed vertices.
  int vertex_slots() const { return static_cast<int>(vertex_records_.size()); }
  const VertexRecord& vertex_record(int slot) const { return vertex_records_[slot]; }
  bool vertex_alive(int slot) const { return vertex_records_[slot].pool >= 0; }
  int dimension(int slot) const;
  const double* state(int slot) const;
  double* state(int slot);
  int state_size(int slot) const;

  // Edges ---------------------------------------------------------------------------------------

  /// Adds an edge on the given vertices. Throws Error for a vertex given twice, for an information
  /// matrix that is not symmetric positive semi-definite, and for unknown parameters.
  template <class E, class... Vs>
  EdgeId add_edge(E edge, VertexId<Vs>... vertices) {
    static_assert(!E::kDynamicArity, "use add_dynamic_edge");
    static_assert(std::is_same_v<std::tuple<Vs...>, typename E::Vertices>,
                  "the vertices are not those of the edge type, in its order");
    edge.vertices = {vertices.slot...};
    return add_typed_edge(std::move(edge));
  }
  template <class E, class... Ls>
  EdgeId add_dynamic_edge(E edge, const std::vector<VertexId<typename E::Many>>& many,
                          VertexId<Ls>... leading) {
    static_assert(std::is_same_v<std::tuple<Ls...>, typename E::Leading>,
                  "the leading vertices are not those of the edge type, in its order");
    if (many.empty()) throw Error("an edge without vertices", "at least one");
    edge.vertices = {leading.slot...};
    for (const VertexId<typename E::Many>& v : many) edge.vertices.push_back(v.slot);
    return add_typed_edge(std::move(edge));
  }
  /// Throws Error when its sizes do not fit the vertices, and like add_edge().
  EdgeId add_dense_prior(DensePrior prior);
  const DensePrior& dense_prior(EdgeId e) const {
    return static_cast<const DensePriorPool&>(*edge_pools_[edge_records_[e.slot].pool])
        .edges[edge_records_[e.slot].index];
  }
  template <class E>
  E& edge(EdgeId e) {
    return static_cast<TypedEdgePool<E>&>(*edge_pools_[edge_records_[e.slot].pool])
        .edges[edge_records_[e.slot].index];
  }
  void remove_edge(EdgeId e);
  /// What an edge is, where that is not what its type says (constraint.h), and how large a
  /// violation of any of its rows counts as none; 0: as the type says. Saved in files. Throws Error
  /// when its Ω does not suit the kind, and for a tolerance below 0.
  void set_constraint(EdgeId e, ConstraintKind kind, double tolerance = 0.0);

  int edge_count() const { return edge_count_; }
  int edge_slots() const { return static_cast<int>(edge_records_.size()); }
  const EdgeRecord& edge_record(int slot) const { return edge_records_[slot]; }
  bool edge_alive(int slot) const { return edge_records_[slot].pool >= 0; }
  std::span<const int> edge_vertices(int slot) const;
  /// Slots of the edges on a vertex, in the order they were added. The first call builds the lists
  /// of all vertices; from then on they are kept up to date.
  const std::vector<int>& incident_edges(int vertex_slot) const;
  void set_kernel(const RobustKernel& kernel);  ///< of every edge

  // Pools ---------------------------------------------------------------------------------------

  std::span<const std::unique_ptr<VertexPool>> vertex_pools() const { return vertex_pools_; }
  std::span<const std::unique_ptr<EdgePool>> edge_pools() const { return edge_pools_; }
  /// All vertices of one type, contiguous; empty when there is none.
  template <class V>
  std::span<const V> vertices_of() const {
    for (const auto& pool : vertex_pools_) {
      if (pool->type() == typeid(V)) return static_cast<const TypedVertexPool<V>&>(*pool).vertices;
    }
    return {};
  }
  template <class E>
  std::span<const E> edges_of() const {
    for (const auto& pool : edge_pools_) {
      if (pool->type() == typeid(E)) return static_cast<const TypedEdgePool<E>&>(*pool).edges;
    }
    return {};
  }

  /// The tag a vertex is written under.
  const std::string& vertex_tag(int slot) const;

  Parameters& parameters() { return parameters_; }
  /// Replaces a parameter, and has all edges look theirs up again (bind() of edge.h). Throws what
  /// they throw.
  void replace_parameter(int number, std::shared_ptr<const Parameter> parameter);
  const Parameters& parameters() const { return parameters_; }

 private:
  friend class GraphReader;

  template <class V>
  int vertex_pool_of() {
    for (std::size_t i = 0; i < vertex_pools_.size(); ++i) {
      if (vertex_pools_[i]->type() == typeid(V)) return static_cast<int>(i);
    }
    vertex_pools_.push_back(std::make_unique<TypedVertexPool<V>>());
    return static_cast<int>(vertex_pools_.size()) - 1;
  }
  template <class E>
  int edge_pool_of() {
    for (std::size_t i = 0; i < edge_pools_.size(); ++i) {
      if (edge_pools_[i]->type() == typeid(E)) return static_cast<int>(i);
    }
    edge_pools_.push_back(std::make_unique<TypedEdgePool<E>>());
    return static_cast<int>(edge_pools_.size()) - 1;
  }
  template <class V>
  V& typed_vertex(int slot) {
    const VertexRecord& record = vertex_records_[slot];
    return static_cast<TypedVertexPool<V>&>(*vertex_pools_[record.pool]).vertices[record.index];
  }
  template <class E>
  EdgeId add_typed_edge(E edge) {
    if constexpr (requires { edge.bind(parameters_); }) edge.bind(parameters_);
    if constexpr (kHasWeights<E>) {
      check_edge(edge.vertices, edge.weights);
    } else {
      check_edge(edge.vertices, edge.information, edge.dimension());
    }
    if constexpr (requires { std::as_const(edge).check(*this); }) std::as_const(edge).check(*this);
    const int pool = edge_pool_of<E>();
    std::vector<E>& edges = static_cast<TypedEdgePool<E>&>(*edge_pools_[pool]).edges;
    edges.push_back(std::move(edge));
    const int index = static_cast<int>(edges.size()) - 1;
    if constexpr (constraint_of<E>() != ConstraintKind::kNone && !kHasWeights<E>) {
      try {
        check_constraint(*edge_pools_[pool], index, constraint_of<E>());
      } catch (const Error&) {
        edges.pop_back();
        throw;
      }
    }
    return {add_edge_record(pool, index, 0)};
  }

  int add_vertex_record(int id, int pool, int index);
  int add_edge_record(int pool, int index, int line);
  static void check_constraint(const EdgePool& pool, int index, ConstraintKind kind);
  void check_edge(std::span<const int> vertices) const;
  void check_edge(std::span<const int> vertices,
                  const Eigen::Ref<const Eigen::VectorXd>& weights) const;
  void check_edge(std::span<const int> vertices,
                  const Eigen::Ref<const Eigen::MatrixXd>& information, int dimension) const;

  std::vector<std::unique_ptr<VertexPool>> vertex_pools_;
  std::vector<std::unique_ptr<EdgePool>> edge_pools_;
  std::vector<VertexRecord> vertex_records_;
  std::vector<EdgeRecord> edge_records_;
  std::vector<std::vector<int>> vertex_slot_of_pool_index_;  ///< [pool][index] → slot
  std::vector<std::vector<int>> edge_slot_of_pool_index_;
  std::unordered_map<int, int> slot_of_id_;
  mutable std::vector<std::vector<int>> incident_;  ///< empty until first asked for
  std::vector<std::string> aliases_;
  Parameters parameters_;
  int vertex_count_ = 0;
  int edge_count_ = 0;
};

}  // namespace locograph
