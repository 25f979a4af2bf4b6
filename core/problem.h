#pragma once
/// A graph compiled for one set of free vertices: every offset an iteration needs, worked out once.
///
///     Problem problem;
///     problem.compile(graph);                    // all vertices that are not fixed, all edges
///     problem.compile(graph, window);            // these vertices free, the edges on them
///     Workspace workspace;
///     workspace.allocate(problem);
///     workspace.load_state();                    // graph → flat state
///     Cost cost = workspace.evaluate(workspace.state());
///     workspace.linearise();                     // fills hessian() and gradient()
///
/// Recompiling costs time proportional to the window, not to the graph, and keeps memory; when the
/// block pattern is unchanged linear solvers keep their analysis. A Problem refers to the graph: it
/// must be compiled again after vertices or edges are added, removed, fixed or freed (changing
/// their values is fine). The order of edges and vertices is that of the graph's pools: results do
/// not depend on anything else.
///
/// Large problems are evaluated in chunks, so that threads can share the work. A chunk holds the
/// edges whose last free vertex lies in its range of block rows, and sums straight into H and the
/// gradient; only where an earlier chunk has already done so it sums aside, and the sums are added
/// in the order of the chunks (`Reduction`). The chunks follow from the problem alone, never from
/// the number of threads: so do the bits of a result.

#include <locograph/core/block_matrix.h>
#include <locograph/core/graph.h>

#include <memory>
#include <span>
#include <vector>

namespace locograph {

class LinearSolver;

/// One constraint edge of a compiled problem.
struct CompiledConstraint {
  int edge = -1;           ///< slot in the graph
  int pool = -1, k = -1;   ///< edge k of pool
  int row = 0, count = 0;  ///< its rows among Workspace::constraint_rows()
  ConstraintKind kind = ConstraintKind::kNone;
};

class Problem {
 public:
  /// A sum of one chunk, kept behind the matrix (or gradient), to be added to its place there.
  struct Reduction {
    std::int64_t from;
    std::int64_t to;
    int size;
  };
  struct Reductions {
    std::vector<Reduction> all;   ///< by destination, then by chunk
    std::vector<int> part_begin;  ///< parts with destinations of their own; parts + 1
    std::int64_t size = 0;        ///< of the array, sums aside included
  };

  void compile(Graph& graph);
  void compile(Graph& graph, std::span<const int> free_vertex_slots);
  /// The same, without the edges that touch a vertex which is neither free nor in `held`: the end
  /// of a horizon is not tied to what lies behind it. Vertices of the window that the graph holds
  /// are seen, held, with all their edges inside it: a constraint that they violate is a constraint
  /// of the window, though nothing in it can be changed.
  void compile(Graph& graph, std::span<const int> free_vertex_slots, std::span<const int> held);

  /// These edges alone, with the vertices on them; free are those that the graph does not hold.
  void compile_on(Graph& graph, std::span<const int> edge_slots);

  /// solver.analyse(pattern()), an error naming vertices rather than block rows.
  void analyse(LinearSolver& solver) const;

  const BlockPattern& pattern() const { return pattern_; }
  int dimension() const { return pattern_.scalar_size(); }
  int state_size() const { return state_size_; }
  int edge_count() const { return edge_count_; }
  /// Number of terms eᵀΩe's scalars, Σ dimension of the edges.
  int residual_count() const { return residual_count_; }
  /// Vertex slot of each block row.
  std::span<const int> free_vertices() const { return free_; }

  Graph& graph() const { return *graph_; }
  std::span<const std::vector<ActiveVertex>> active() const { return active_; }
  std::span<const CompiledEdges> edges() const { return edges_; }
  std::span<const CompiledConstraint> constraints() const { return constraints_; }
  int constraint_rows() const { return constraint_rows_; }
  std::size_t scratch_bytes() const { return scratch_bytes_; }
  int chunks() const { return chunks_; }
  const Reductions& hessian_reductions() const { return hessian_reductions_; }
  const Reductions& gradient_reductions() const { return gradient_reductions_; }

 private:
  void begin(Graph& graph);
  void add_vertex(int slot, int tangent_offset);
  void compile_window(std::span<const int> free_vertex_slots, const std::span<const int>* held);
  void compile_edges();
  void divide_into_chunks();
  void compile_constraints();
  void build_pattern();
  void build_offsets();

  /// Gives each chunk that sums into a place a destination of its own, the first one the place.
  class Destinations {
   public:
    void start(std::int64_t places, std::int64_t size);
    std::int64_t of(std::int64_t place, std::int64_t own, int size, int chunk);
    void finish(Reductions& out);

   private:
    struct Last {
      int chunk = -1;
      std::int64_t offset = 0;
    };
    std::vector<Last> last_;
    std::vector<Reduction> reductions_;
    std::int64_t size_ = 0;
  };

  struct Place {
    int block = -1;  ///< block row, -1 when fixed
    int state_offset = -1;
    int derived_index = -1;
  };

  Graph* graph_ = nullptr;
  std::vector<int> free_;
  std::vector<int> touched_;  ///< slots whose place is set, to clear it cheaply
  std::vector<Place> place_;  ///< by vertex slot
  std::vector<std::vector<ActiveVertex>> active_;
  std::vector<CompiledEdges> edges_;
  BlockPattern pattern_;
  std::vector<std::uint64_t> pairs_;
  std::vector<int> compiled_slots_;  ///< of all edges
  std::vector<double> work_;         ///< of the edges that end in each block row
  std::vector<int> chunk_of_, sorted_;
  Destinations hessian_destinations_, gradient_destinations_;
  int chunks_ = 1;
  Reductions hessian_reductions_, gradient_reductions_;
  std::vector<CompiledConstraint> constraints_;
  int constraint_rows_ = 0;
  int state_size_ = 0;
  int edge_count_ = 0;
  int residual_count_ = 0;
  std::size_t scratch_bytes_ = 0;
};

}  // namespace locograph
