#pragma once
/// Minimises Σ ρ(eᵀΩe) over the free vertices of a problem: Gauss-Newton, Levenberg-Marquardt or
/// Powell's dogleg.
///
///     OptimiserOptions options;
///     OptimiserResult result = optimise(graph, options, *make_linear_solver("auto"));
///     if (!result.converged) std::cerr << result.reason_text();
///
/// Step by step, on a problem compiled once (a moving horizon does this every cycle):
///
///     Optimiser optimiser(options);
///     optimiser.start(workspace, solver);     // evaluates; may allocate
///     while (optimiser.iterate()) {}          // does not allocate
///     workspace.store_state();
///
/// OptimiserOptions::for_any_start() is for values that may be poor. With nonmonotonic_steps the
/// cost may rise for a few steps, along a bent valley where a cost that must fall creeps.
///
/// Levenberg-Marquardt follows Madsen, Nielsen & Tingleff 2004 (gain ratio and Nielsen's update of
/// λ, their algorithm 3.16); the dogleg their algorithm 3.21. Deterministic.

#include <locograph/common/deadline.h>
#include <locograph/core/linear_solver.h>
#include <locograph/core/reference_cost.h>
#include <locograph/core/workspace.h>

#include <functional>
#include <string>
#include <vector>

namespace locograph {

enum class Algorithm { kGaussNewton, kLevenbergMarquardt, kDogleg };

struct OptimiserResult;

struct OptimiserOptions {
  Algorithm algorithm = Algorithm::kLevenbergMarquardt;
  int max_iterations = 100;
  /// Converged when an accepted step lowers the cost by less than this fraction of it.
  double gain = 1e-9;
  /// Converged when no entry of the gradient JᵀΩe is larger.
  double gradient_tolerance = 1e-10;
  /// Converged when |step| is below this fraction of |state|.
  double step_tolerance = 1e-12;
  /// First λ, as a fraction of the largest diagonal entry of H: next to nothing, since a good first
  /// guess is best followed by Gauss-Newton steps.
  double initial_lambda = 1e-12;
  /// A refused step makes λ at least this fraction: the customary first value where the model is
  /// not to be trusted.
  double refused_lambda = 1e-5;
  /// Damp by λ·D instead of λ·I, D the largest that each diagonal entry of H has been so far:
  /// independent of the units of the variables (Marquardt 1963), and a direction that is flat just
  /// now does not run away (Moré 1978, section 6). The two options above are then λ itself.
  bool scale_by_diagonal = false;
  /// With scale_by_diagonal, for values that may be poor. Steps with next to no damping come first;
  /// when one of them is refused that was to lower the cost by more than a hundredth, the run
  /// begins again at its first state with λ = refused_lambda, and from there on is that of a trust
  /// region of radius 1/λ as Ceres has it: D is the diagonal of now, but at least 1e-6 of the first
  /// one, and λ moves by Nielsen's factors alone. The run ends at the best state that it has seen.
  bool follow_diagonal = false;
  /// Of Levenberg-Marquardt, for costs whose second derivatives jump, as those of hinged rows do
  /// (constraint.h). A refused step is cut short in its direction, so that the next linearisation
  /// knows the rows it ran into; λ rises by tens only, and falls ever faster as long as whole steps
  /// do what the model says. Without this a stiff row that begins to act raises λ by many orders,
  /// for all directions, and tens of iterations crawl until it has come down by thirds.
  bool shorten_steps = false;
  /// How often such a step may be cut before λ rises instead; each cut is an evaluation.
  int max_cuts = 20;
  /// Of Levenberg-Marquardt and the dogleg: steps in a row that may leave the cost above the least
  /// so far (reference_cost.h); the run ends at the best state that it has seen. With 0 every step
  /// lowers the cost, and the workspace holds the best state after each, which a caller that stops
  /// when it likes relies on. 5 is the
  /// number of Ceres: often fewer steps from poor values, now and then to another minimum.
  int nonmonotonic_steps = 0;
  /// First trust-region radius of the dogleg, in units of the tangent.
  double initial_radius = 1e4;
  /// Steps that may be refused in a row before the iteration gives up.
  int max_refusals = 16;
  Deadline deadline;
  /// Called after every iteration; false stops the run. The result so far holds the statistics of
  /// the iteration; the workspace holds its state.
  std::function<bool(const OptimiserResult&)> on_iteration;

  /// Levenberg-Marquardt for values that may be good or poor, as those in a file: follow_diagonal.
  /// Good ones still take Gauss-Newton steps.
  static OptimiserOptions for_any_start();

  /// Throws Error naming the option that is out of range.
  void validate() const;
};

struct IterationStatistics {
  double cost = 0.0, chi2 = 0.0;
  double gain_ratio = 0.0;
  double lambda = 0.0;  ///< or the trust-region radius
  double step_norm = 0.0;
  int refusals = 0;
  double time_linearise = 0.0, time_solve = 0.0, time_evaluate = 0.0;  ///< seconds
};

struct OptimiserResult {
  enum class Reason {
    kRunning,
    kGain,
    kGradient,
    kStep,
    kMaxIterations,
    kDeadline,
    kNoProgress,   ///< no damping gave a lower cost; see promised_decrease
    kSingular,     ///< H is not positive definite: singular_vertex says where
    kNotFinite,    ///< the initial cost is not a number
    kDiverged,     ///< Gauss-Newton raised the cost
    kNothingToDo,  ///< no free vertex
    kStopped,      ///< OptimiserOptions::on_iteration said so
  };
  Reason reason = Reason::kRunning;
  bool converged = false;
  int iterations = 0;
  Cost initial, final;
  /// With kNoProgress, the decrease that the gradient promised of the last iteration's first step,
  /// as a fraction of the cost. Where it is not tiny, the Jacobian of an edge is not the derivative
  /// of its error: diagnose() compares them.
  double promised_decrease = 0.0;
  int singular_vertex = -1;                     ///< slot, -1 when H was never singular
  std::vector<IterationStatistics> statistics;  ///< of the first 10 000 iterations

  std::string reason_text() const;
};

class Optimiser {
 public:
  explicit Optimiser(const OptimiserOptions& options) : options_(options) { options.validate(); }

  /// The workspace must hold the initial state (load_state()). evaluated: nothing has written into
  /// its state() since it was evaluated, see Workspace::return_to_state().
  void start(Workspace& workspace, LinearSolver& solver, bool evaluated = false);
  /// One accepted step; false when it is over.
  bool iterate();
  /// Between iterations: costs have changed, as with other bindings, but no state. The run goes on
  /// with the damping and the count of iterations that it has.
  void costs_changed();
  /// Continues a run that ended because every step of an iteration was refused. The next iteration
  /// keeps the damping and reuses the linearisation.
  void go_on_refused();
  /// Whether the next iteration begins with what was linearised before.
  bool is_linearised() const { return linearised_; }
  const OptimiserResult& result() const { return result_; }
  OptimiserOptions& options() { return options_; }

 private:
  bool finish(OptimiserResult::Reason reason);
  bool finish_refused(OptimiserResult::Reason converged, double promised);
  /// Whether the present state may be worse than one before.
  bool may_rise() const {
    return (options_.nonmonotonic_steps > 0 || options_.follow_diagonal) &&
           options_.algorithm != Algorithm::kGaussNewton;
  }
  void go_to(const std::vector<double>& state, const Cost& cost);
  void return_to_best();
  bool begin_again();
  bool iterate_gauss_newton(IterationStatistics& now);
  bool iterate_levenberg_marquardt(IterationStatistics& now);
  void update_scaling();
  bool iterate_dogleg(IterationStatistics& now);
  bool solve(IterationStatistics& now);
  Cost evaluate_trial(IterationStatistics& now);
  bool shorten(Cost& cost, IterationStatistics& now);
  bool accept(const Cost& cost, double predicted, IterationStatistics& now, bool whole = true);
  double state_norm() const;

  OptimiserOptions options_;
  Workspace* workspace_ = nullptr;
  LinearSolver* solver_ = nullptr;
  OptimiserResult result_;
  Cost cost_, best_cost_;
  ReferenceCost reference_;
  double lambda_ = 0.0, lambda_unit_ = 1.0, lambda_growth_ = 2.0;
  double lambda_fall_ = 0.0, radius_ = 0.0;
  bool refused_ = false;     ///< a step, of this run
  bool linearised_ = false;  ///< the state, see go_on_refused()
  double promised_ = 0.0;    ///< by the first step from there
  std::vector<double> diagonal_, scaling_, newton_step_, negative_gradient_;
  std::vector<double> first_diagonal_, first_state_;
  std::vector<double> best_state_;  ///< where the cost has risen since
};

/// Compiles, optimises and writes the result back to the graph. Vertices that are fixed stay. The
/// threads share the work of large problems; they never change a bit of the result.
OptimiserResult optimise(Graph& graph, const OptimiserOptions& options, LinearSolver& solver,
                         ThreadPool* threads = nullptr);

}  // namespace locograph
