#pragma once
/// All edges of one concrete type, by value and contiguous, behind one virtual interface.
///
/// The solver calls a pool once per pass; inside, everything has compile-time sizes where the edge
/// type has them, and each edge writes its blocks of JᵀΩJ and its segments of JᵀΩe straight to
/// offsets computed when the problem was compiled. The templates that do it are in
/// edge_evaluation.h; edge types are instantiated where they are registered, nowhere else.

#include <locograph/core/bindings.h>
#include <locograph/core/constraint.h>
#include <locograph/core/edge.h>
#include <locograph/core/row_label.h>
#include <locograph/core/scratch.h>
#include <locograph/core/vertex_pool.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <typeindex>
#include <vector>

namespace locograph {

/// The edges of one pool that take part in a problem, with the offsets they read and write.
struct CompiledEdges {
  struct Slot {
    const VertexPool* pool;  ///< of the vertex
    int vertex_index;        ///< in its pool
    int pool_number;         ///< of its pool, in Evaluation::derived
    int derived_index;       ///< in that DerivedStore
    int state_offset;        ///< in the flat state
    int tangent_offset;      ///< in the step; -1 when the vertex is held fixed
    int gradient_offset;     ///< where this edge's share of the gradient is summed
  };
  /// A Hessian block: twice its offset, plus one when the transpose is stored; -1 for none.
  using Block = std::int64_t;

  std::vector<int> edges;        ///< indices in the pool, ascending within a chunk
  std::vector<int> chunk_begin;  ///< first edge of each chunk (see problem.h); chunks + 1
  std::vector<int> slot_begin;   ///< edges + 1
  std::vector<Slot> slots;
  std::vector<std::int64_t> block_begin;  ///< edges + 1
  std::vector<Block> blocks;  ///< for each edge the pairs (i, j), i ≤ j, of its slots, row by row
  /// For each edge its first row in Evaluation::constraint_rows, -1 when it is no constraint; empty
  /// when none is.
  std::vector<int> constraint_row;
  std::vector<char> one_sided;  ///< likewise: whether it is an inequality

  void clear() {
    edges.clear();
    chunk_begin.assign(2, 0);
    slot_begin.assign(1, 0);
    slots.clear();
    block_begin.assign(1, 0);
    blocks.clear();
    constraint_row.clear();
    one_sided.clear();
  }
};

/// What an evaluation reads.
struct Evaluation {
  const double* state;
  std::span<const std::unique_ptr<DerivedStore>> derived;  ///< one for each vertex pool
  Scratch* scratch;
  const ConstraintRow* constraint_rows = nullptr;  ///< null: constraints are ordinary edges
  /// By the same rows: errors as the types give them, written by cost(), read by linearise(), which
  /// is called on the same state.
  double* constraint_errors = nullptr;
  const Bindings* bindings = nullptr;  ///< null: none
  /// constraint_errors are those of the state: cost() does not work them out.
  bool errors_known = false;
};

/// A sum over edges: with the robust kernels, and without.
struct Cost {
  double robust = 0.0;  ///< Σ ρ(eᵀΩe)
  double chi2 = 0.0;    ///< Σ eᵀΩe
  Cost& operator+=(const Cost& other) {
    robust += other.robust;
    chi2 += other.chi2;
    return *this;
  }
};

class EdgePool {
 public:
  explicit EdgePool(std::string tag) : tag_(std::move(tag)) {}
  virtual ~EdgePool() = default;

  const std::string& tag() const { return tag_; }
  virtual std::type_index type() const = 0;
  virtual int size() const = 0;
  /// Fixed arity, or -1 when each edge has its own.
  virtual int arity() const = 0;
  virtual int dimension(int index) const = 0;
  virtual std::span<const int> vertices(int index) const = 0;
  virtual std::span<int> vertices(int index) = 0;
  /// The type of vertex in a given slot, and an empty pool of it; void and null where any will do.
  virtual std::type_index slot_type(int slot) const = 0;
  virtual std::unique_ptr<VertexPool> make_slot_pool(int slot) const = 0;
  virtual bool has_weights() const = 0;                  ///< Ω is diagonal
  virtual bool one_sided() const = 0;                    ///< the error is hinged: never negative
  virtual bool reads_bindings() const { return false; }  ///< the error depends on them
  /// What its edges are unless the graph says otherwise.
  virtual ConstraintKind constraint() const { return ConstraintKind::kNone; }
  virtual double weight(int index, int row) const = 0;  ///< on the diagonal of Ω
  virtual Eigen::MatrixXd information(int index) const = 0;
  virtual void set_information(int index, const Eigen::MatrixXd& information) = 0;
  virtual RobustKernel& kernel(int index) = 0;

  virtual std::size_t scratch_bytes(const CompiledEdges& edges) const = 0;
  /// Error of one edge, unweighted, as its type gives it also where it is a constraint.
  virtual void error(const CompiledEdges& edges, int k, const Evaluation& x,
                     double* error) const = 0;
  /// Of edges [begin, end) of the list.
  virtual Cost cost(const CompiledEdges& edges, int begin, int end, const Evaluation& x) const = 0;
  /// Adds JᵀΩJ of those edges to `hessian` and JᵀΩe to `gradient`; returns their cost.
  virtual Cost linearise(const CompiledEdges& edges, int begin, int end, const Evaluation& x,
                         double* hessian, double* gradient) const = 0;
  /// Jacobian of edge k by slot, dimension × tangent: as linearise() uses it (numeric = false), or
  /// by central differences on local copies (numeric = true). For tests; allocates.
  virtual Eigen::MatrixXd jacobian(const CompiledEdges& edges, int k, int slot, const Evaluation& x,
                                   bool numeric) const = 0;

  /// State of the vertex in `slot` from that of the other one of a binary edge. False when the
  /// type cannot tell.
  virtual bool predict(int index, int slot, const double* other_state, double* state) const = 0;

  virtual void bind(int index, const Parameters& parameters) = 0;
  /// Reads measurement and information; `vertices` are already known. Returns the new index.
  virtual int read(std::span<const int> vertices, FieldReader& in) = 0;
  /// Throws Error when an edge that was read does not fit its vertices.
  virtual void check(int /*index*/, const Graph& /*graph*/) const {}
  virtual void write(int index, FieldWriter& out) const = 0;
  /// Removes by moving the last edge into the gap.
  virtual void remove(int index) = 0;

  /// Of a row of edge k: how large a violation counts as none; 0 where the type says nothing. Does
  /// not allocate.
  virtual double row_tolerance(const CompiledEdges& /*edges*/, int /*k*/, int /*row*/) const {
    return 0.0;
  }
  /// Of a row of edge k, at the states in the graph; empty where the type says nothing.
  virtual RowLabel row_label(const CompiledEdges& /*edges*/, int /*k*/, int /*row*/) const {
    return {};
  }

 private:
  std::string tag_;
};

}  // namespace locograph
