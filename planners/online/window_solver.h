#pragma once
/// Optimises the window of an online planner on one compiled problem, an iteration at a time.
///
///     WindowSolver solver{WindowSolverOptions()};
///     solver.compile(window, false);
///     solver.load_state();
///     solver.begin(WindowSolver::Start::kIncumbent);
///     while (solver.step(termination, statistics)) {
///     }
///     incumbent.offer(solver.quality(), solver.state());
///
/// A run goes on over cycles as long as the window stays what it is, also in a world that is new,
/// with the damping λ that it has. Each is one of
/// Levenberg-Marquardt or, after begin_raising(), of the augmented Lagrangian of core, which raises
/// the constraints that are violated still; its multipliers are kept by edge from cycle to cycle.
///
/// Nothing is evaluated twice: a run begins with what is known of the state it begins from, and a
/// world that is new needs no new kinematics. The structure of the compiled problem is kept while
/// the window slides.

#include <locograph/core/augmented_lagrangian.h>
#include <locograph/planners/online/cycle_report.h>
#include <locograph/planners/online/window.h>
#include <locograph/planners/online/window_quality.h>

#include <memory>
#include <vector>

namespace locograph {

struct WindowSolverOptions {
  int max_iterations = 15;  ///< of one optimisation
  int max_rounds = 3;       ///< of the augmented Lagrangian, after the first optimisation; 0: off
  double raise = 10.0;      ///< growth of a penalty from round to round
  double max_raise = 1e4;   ///< to which they grow, in all cycles together
  double gain = 1e-3;       ///< see OptimiserOptions
  double feasible_gain = 0.03;  ///< of one iteration that ends in a feasible window: enough

  void validate() const;
};

class WindowSolver {
 public:
  /// The window that a run starts from: the one that the last cycle handed out, or one beside it.
  /// Each has a damping of its own.
  enum class Start { kIncumbent, kCandidate };

  explicit WindowSolver(const WindowSolverOptions& options);
  ~WindowSolver();

  /// Of a window that has moved. A run ends. slid: along a graph in which nothing but states has
  /// changed since the last one; what is known of it holds then.
  void compile(const Window& window, bool slid);
  /// The world has changed. A run goes on in it.
  void rebind(const Bindings& bindings);
  /// Graph → state(). A run ends.
  void load_state();
  /// As the one that it has already, or another one: then a run ends.
  void set_state(const std::vector<double>& state);
  void store(const std::vector<double>& state) const { workspace_.store(state); }  ///< → graph
  const std::vector<double>& state() { return workspace_.state(); }
  const Problem& problem() const { return problem_; }

  /// Of the state, and of another one.
  WindowQuality quality();
  WindowQuality quality_of(const std::vector<double>& state);

  /// From the state.
  void begin(Start start);
  void begin_raising();
  bool running() const { return run_ != RunKind::kNone; }
  /// One iteration of the run. With a termination that counts iterations it tries one or two steps;
  /// if all are refused, the next iteration keeps the damping and reuses the linearisation. False:
  /// the run is over.
  bool step(const Termination& termination, WindowStatistics& statistics);
  void end_run();
  /// By the last iteration. After one that took no step nobody knows yet how much there is to gain.
  bool gained_little() const;

  /// One iteration from the state, so that memory and the order of elimination are there.
  void prepare();

  ConstraintViolation describe(const ConstraintReader::Row& row) const {
    return reader_.describe(row);
  }

 private:
  struct Multiplier;
  enum class RunKind { kNone, kPlain, kRaising };

  template <class Take>
  void each_kept(const Take& take) const;
  void restore_multipliers();
  void keep_multipliers();
  void begin_run();
  bool step_plain(const Termination& termination);
  bool step_raising(const Termination& termination, WindowStatistics& statistics);
  void learn();
  double& lambda() { return start_ == Start::kIncumbent ? incumbent_lambda_ : candidate_lambda_; }

  WindowSolverOptions options_;
  Problem problem_;
  Workspace workspace_;
  ConstraintReader reader_;
  std::unique_ptr<LinearSolver> linear_solver_;
  Optimiser optimiser_;
  ConstrainedOptimiser raising_;
  std::vector<double> diagonal_;
  /// With which runs begin, in units of the largest diagonal entry.
  double incumbent_lambda_, candidate_lambda_;
  RunKind run_ = RunKind::kNone;
  Start start_ = Start::kIncumbent;
  bool begins_ = false;    ///< the run, with the next step
  bool goes_on_ = false;   ///< raising, in a window that has moved
  bool rebound_ = false;   ///< since the last step of the run
  int refused_ = 0;        ///< iterations in a row that took no step
  WindowQuality quality_;  ///< of the state
  bool quality_known_ = false;
  bool raised_ = false;                  ///< since compile()
  double gain_ = 1.0;                    ///< of the last iteration, as a fraction of the cost
  std::vector<int> step_of_;             ///< of the constraints, see window_quality()
  int steps_ = 0;                        ///< of the window
  std::vector<Multiplier> multipliers_;  ///< by edge slot, ascending
};

}  // namespace locograph
