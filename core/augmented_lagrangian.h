#pragma once
/// Minimises Σ ρ(eᵀΩe) subject to the edges marked as constraints: an augmented Lagrangian whose
/// rounds run on one compiled structure.
///
///     graph.set_constraint(e, ConstraintKind::kEquality);       // see constraint.h
///     ConstrainedResult result = optimise_constrained(graph, {}, *make_linear_solver("auto"));
///     if (!result.converged) std::cerr << result.reason_text(graph);
///
/// A round minimises the cost with the constraints' shifted penalties by the inner algorithm, then
/// moves the multipliers (shift ← shift + c, for inequalities max(0, shift + g)) and raises the
/// penalty, by row, where the violation did not fall enough: Nocedal & Wright 2006, framework 17.3
/// and algorithm 17.4; the shifts as in Toussaint 2014 (arXiv:1412.4329). Where Ω is not diagonal
/// the penalty of an edge's rows is raised together. Rows of weight zero are no constraints.
///
/// Scale constraints by their Ω: the first penalty is Ω itself, and a value near the curvature of
/// the cost needs the fewest rounds. Without constraints this is one run of the inner algorithm.

#include <locograph/core/optimiser.h>

#include <memory>
#include <string>
#include <vector>

namespace locograph {

struct ConstrainedOptions {
  ConstrainedOptions() {
    inner.gain = 1e-14;
    inner.max_iterations = 200;
    inner.shorten_steps = true;
  }
  /// Of every round. Its deadline and callback hold for the whole run.
  OptimiserOptions inner;
  int max_rounds = 50;
  /// Largest violation of a row at convergence, in the unit of its error; for inequalities also the
  /// largest distance from the boundary, in that unit, of a row that still has a multiplier.
  double tolerance = 1e-8;
  /// Rows whose edge or type has a tolerance (Graph::set_constraint, edge.h) are held to that.
  bool own_tolerances = false;
  double initial_penalty = 1.0;  ///< factor on Ω
  double growth = 10.0;          ///< of a penalty that is raised
  double max_penalty = 1e10;     ///< factor on Ω; reached without effect: infeasible
  /// A round must bring a row's violation below this fraction of what it was.
  double decrease = 0.25;

  /// Throws Error naming the option that is out of range.
  void validate() const;
};

/// Where a constraint edge stands.
struct ConstraintState {
  EdgeId edge;
  double violation = 0.0;  ///< of its worst row, in that row's unit: |c|, max(0, g)
  int row = 0;             ///< the worst one
  /// λ of Σ eᵀΩe + λᵀc, by row; zero for types that hinge by themselves.
  std::vector<double> multipliers;
};

struct ConstrainedResult {
  enum class Reason {
    kConverged,
    /// A violation stays at the largest penalty: no point near satisfies the constraints, or the
    /// tolerance is finer than rounding allows. `worst` names one.
    kInfeasible,
    kMaxRounds,    ///< the rounds are used up
    kInnerFailed,  ///< `inner` says why: singular, not finite, deadline, stopped
  };
  Reason reason = Reason::kMaxRounds;
  bool converged = false;
  int rounds = 0;
  int iterations = 0;                        ///< of all rounds
  Cost cost;                                 ///< of the edges that are no constraints
  std::vector<ConstraintState> constraints;  ///< in the order of Problem::constraints()
  int worst = -1;                            ///< of the constraints, -1 when there is none
  OptimiserResult inner;                     ///< of the last round

  /// Names the worst constraint by its tag and vertices.
  std::string reason_text(const Graph& graph) const;
};

/// Compiles, optimises and writes the result back to the graph.
ConstrainedResult optimise_constrained(Graph& graph, const ConstrainedOptions& options,
                                       LinearSolver& solver);

/// The same on a compiled problem. The workspace holds the initial state (load_state()); `warm`
/// keeps the multipliers and penalties of the last call, for a problem that changed little.
ConstrainedResult optimise_constrained(Workspace& workspace, const ConstrainedOptions& options,
                                       LinearSolver& solver, bool warm = false);

/// The same an iteration at a time:
///
///     ConstrainedOptimiser optimiser(options);
///     optimiser.start(workspace, solver, true);
///     while (optimiser.iterate()) {}
class ConstrainedOptimiser {
 public:
  explicit ConstrainedOptimiser(const ConstrainedOptions& options);
  ~ConstrainedOptimiser();

  /// As optimise_constrained(). evaluated: see Optimiser::start().
  void start(Workspace& workspace, LinearSolver& solver, bool warm, bool evaluated = false);
  /// The run goes on in another problem that shares most of the last one's, such as a window that
  /// has moved: in the same round, which then ends after a few iterations, as nothing converges in
  /// a problem that changes. The workspace has multipliers and penalties; last_violations() are to
  /// be given.
  void go_on(Workspace& workspace, LinearSolver& solver, bool evaluated);
  /// By constraint row, at the end of the last round; infinite before the first one.
  std::vector<double>& last_violations();

  /// One iteration of the inner algorithm, and the end of a round where it ends with it. False when
  /// all is over: Workspace::constraint_errors() are then those of its state.
  bool iterate();
  /// See Optimiser.
  void costs_changed() { inner_.costs_changed(); }

  ConstrainedResult::Reason reason() const { return reason_; }
  int rounds() const { return rounds_; }
  int iterations() const { return finished_iterations_ + inner_.result().iterations; }
  const OptimiserResult& inner() const { return inner_.result(); }
  /// Those of the inner algorithm: its deadline and callback may be changed between iterations.
  OptimiserOptions& inner_options() { return inner_.options(); }
  /// Once it is over. Allocates.
  ConstrainedResult result();

 private:
  class Rows;
  bool end_round(bool cut_short);

  ConstrainedOptions options_;
  Optimiser inner_;
  std::unique_ptr<Rows> rows_;
  Workspace* workspace_ = nullptr;
  LinearSolver* solver_ = nullptr;
  ConstrainedResult::Reason reason_ = ConstrainedResult::Reason::kMaxRounds;
  int rounds_ = 0;
  int finished_iterations_ = 0;  ///< of the rounds that are over
  int round_iterations_ = 0;     ///< of this one, when the run goes on
  bool goes_on_ = false;         ///< since this round began
  bool raised_ = true;
  bool over_ = true;
};

}  // namespace locograph
