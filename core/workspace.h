#pragma once
/// The numbers of a compiled problem: state, derived quantities, H, gradient, step. Allocated once.
///
/// See problem.h for the order of calls. linearise() uses the derived quantities of the last
/// evaluate(), so it is called on the state that was evaluated last: that is why an accepted trial
/// costs no second kinematics.
///
/// With use_threads() the chunks of a large problem are shared between threads; the bits of every
/// number stay what they are on one thread.

#include <locograph/common/thread_pool.h>
#include <locograph/core/problem.h>

namespace locograph {

class Workspace {
 public:
  /// Keeps memory that is large enough. The problem must outlive the workspace's use.
  void allocate(const Problem& problem);
  /// Called before the problem is compiled again for a window that has slid along an otherwise
  /// unchanged graph: what is known at state() holds after the load_state() that comes next, for
  /// vertices whose state is the same, and edges on such vertices whose rows are. Costs are summed
  /// to the same bits. Until then nothing may be read.
  void keep();
  /// Null for the caller's thread alone. The pool must outlive the workspace's use.
  void use_threads(ThreadPool* threads) { threads_ = threads; }
  /// Parameters that stand in for those of the problem's graph from the next evaluate() on, until
  /// others are bound; none once it is allocated anew. Comes between evaluations: a run that is
  /// under way would compare costs of different parameters. Throws Error when they do not fit.
  void bind(const Bindings& bindings);
  const Bindings& bindings() const { return bindings_; }
  void load_state();                                   ///< graph → state()
  void store_state() const { store(state_); }          ///< state() → graph
  void store(const std::vector<double>& state) const;  ///< one of this size → graph

  /// To change it, apply_step() and accept_trial(): a fixed vertex has a copy in trial() too.
  std::vector<double>& state() { return state_; }
  std::vector<double>& trial() { return trial_; }
  /// Overwrites state(). One that is the same to the last bit stays evaluated if it was.
  void set_state(const std::vector<double>& state);
  std::span<double> hessian() {
    return {hessian_.data(), static_cast<std::size_t>(problem_->pattern().values())};
  }
  /// JᵀΩe
  std::span<double> gradient() {
    return {gradient_.data(), static_cast<std::size_t>(problem_->dimension())};
  }
  std::vector<double>& step() { return step_; }
  std::vector<double>& damping() { return damping_; }
  /// Of the problem's constraints(); as allocated: no shift, scale 1. Costs of before they are
  /// changed do not count any more.
  std::vector<ConstraintRow>& constraint_rows() {
    evaluated_ = partly_ = nullptr;
    rows_changed_ = true;
    rows_as_allocated_ = false;
    return constraint_rows_;
  }
  const std::vector<ConstraintRow>& constraint_rows() const { return constraint_rows_; }
  /// By the same rows: their errors at the state evaluated last, as the edges' types give them.
  const std::vector<double>& constraint_errors() const { return constraint_errors_; }

  /// trial = state ⊞ step.
  void apply_step();
  void accept_trial() {
    state_.swap(trial_);
    partly_ = nullptr;
  }

  /// Derives the quantities of `state` and sums the cost. Returns a non-finite cost for a state
  /// that cannot be evaluated. What an edge throws gets the line that the edge was read from.
  Cost evaluate(const std::vector<double>& state);
  /// The cost at state() of a workspace that nobody has written into since it was evaluated, but by
  /// bind() and set_state(). Evaluates it where that is needed: not where it was evaluated last, as
  /// it is after a run whose last trial was accepted. Where only the bindings or constraint rows
  /// are others, what was derived of it stays; with keep() so do costs that do not depend on them,
  /// and errors of constraints.
  Cost return_to_state();
  /// Fills hessian() and gradient() at state(), which was evaluated last.
  Cost linearise();
  /// Error vector of edge k of pool p at the state evaluated last.
  void error(int pool, int k, double* error);
  /// One edge as linearise() counts it, shift, scale and hinge of a constraint included. Allocates.
  struct Linearised {
    Eigen::VectorXd error;
    std::vector<Eigen::MatrixXd> jacobians;  ///< by slot; empty for vertices that are held
    double weight = 1.0;                     ///< of the robust kernel
  };
  Linearised linearise_edge(int pool, int k);

  /// The diagonal of H.
  void diagonal(std::vector<double>& diagonal) const;
  /// xᵀ H x.
  double quadratic_form(const std::vector<double>& x) const;

  const Problem& problem() const { return *problem_; }

 private:
  /// What a DerivedStore was made for.
  struct DerivedFor {
    const VertexPool* pool = nullptr;
    std::type_index type = typeid(void);
    std::vector<int> state_sizes;

    bool is_of(const VertexPool& other) const { return pool == &other && type == other.type(); }
    bool fits(const VertexPool& other, std::span<const ActiveVertex> active) const;
    void assign(const VertexPool& other, std::span<const ActiveVertex> active);
  };

  void throw_with_line(const std::vector<double>& state);
  Evaluation evaluation(const std::vector<double>& state, int chunk) {
    return {state.data(),
            derived_,
            &scratch_[chunk],
            constraint_rows_.data(),
            constraint_errors_.data(),
            &bindings_};
  }
  template <class Task>
  void for_each(int count, Task&& task);
  template <class Task>
  Cost sum_chunks(Task&& task);
  void derive(const std::vector<double>& state);
  /// Which edges have to be evaluated.
  enum class Stale { kAll, kChanged, kUnknown };
  Cost sum_costs(const std::vector<double>& state, Stale stale);
  void take_over();
  void take_over_vertices(std::size_t pool);
  void take_over_edges(std::size_t pool, bool same_bindings);
  void reduce(const Problem::Reductions& reductions, std::vector<double>& values);

  const Problem* problem_ = nullptr;
  Bindings bindings_;
  std::vector<ConstraintRow> constraint_rows_;
  std::vector<double> constraint_errors_;
  /// The buffer, state or trial, that was evaluated last; that of whose numbers all is derived;
  /// that whose costs are known but for what has changed since.
  const double *evaluated_ = nullptr, *derived_from_ = nullptr, *summed_ = nullptr;
  bool bindings_changed_ = false, rows_changed_ = false;  ///< since costs were summed
  Cost evaluated_cost_;
  std::vector<double> state_, trial_, hessian_, gradient_, step_, damping_;
  std::vector<std::unique_ptr<DerivedStore>> derived_;
  std::vector<DerivedFor> derived_for_;
  std::vector<Scratch> scratch_;  ///< one for each chunk
  std::vector<Cost> chunk_costs_;
  ThreadPool* threads_ = nullptr;
  bool rows_as_allocated_ = false;  ///< nobody has written into constraint_rows_

  // See keep().
  struct Kept {
    bool valid = false, world = false;  ///< the edges that read the bindings, too
    Bindings bindings;
    std::vector<std::vector<ActiveVertex>> active;
    std::vector<double> state, errors;
    std::vector<ConstraintRow> rows;  ///< empty: as allocated
    std::vector<std::vector<int>> edges, constraint_row;
    std::vector<std::vector<Cost>> costs;
  };
  bool keeps_ = false, by_edge_ = false;  ///< the latter since it was allocated last
  Kept kept_;
  std::vector<std::vector<Cost>> edge_costs_;      ///< by pool and edge
  std::vector<std::vector<char>> known_edges_;     ///< at partly_, likewise
  std::vector<std::vector<char>> known_vertices_;  ///< by pool and active vertex
  const double* partly_ = nullptr;  ///< the buffer of which a part is known, before it is evaluated
  std::vector<std::pair<int, int>>
      place_;  ///< of a kept vertex: index in its pool, and in `active`
  std::vector<int> from_, sizes_;
  std::vector<char> used_;
};

}  // namespace locograph
