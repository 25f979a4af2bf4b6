#pragma once
/// The online planner: keeps the next configurations of a plan valid while the world changes.
///
///     LocalPlanner planner(plan_graph, options);
///     for (int executed = 0; executed + 1 < planner.plan_size(); ++executed) {
///       planner.show(world);                            // what the sensors see now; optional
///       CycleReport cycle = planner.cycle(executed);    // refines executed + 1 … executed + H
///       if (!cycle.next_feasible) break;                // stop: the robot stays where it is
///     }
///
/// Each cycle frees the H configurations behind the executed one, and vertices of other types that
/// belong to them alone, and holds the rest: what was executed is seen through the edges that reach
/// back to it (rolling, velocity, acceleration), what lies behind the window is not. A few
/// Levenberg-Marquardt steps start from the last cycle's result; a configuration that enters the
/// window goes on from those before it. If constraints are still violated, or the window
/// falls behind the plan, a detour is searched (detour_search.h) and optimised from there. What
/// then is violated is raised by the augmented Lagrangian of core, whose multipliers stay with
/// their edges from cycle to cycle.
///
/// Constraints are whatever the edges of the graph say (core/violations.h), those of plug-ins too.
/// The graph only ever gets a window that is better than the one it had (window_quality.h), at a
/// deadline as well: what is not better yet is gone on with in the next cycle, aside. A cycle
/// ends at most one iteration after its deadline. Constraints that cannot be met are reported, with
/// place and size; nothing is handed out as feasible that is not.
///
/// Time and memory of a cycle depend on H, not on the length of the plan; the structure of the
/// compiled window is kept while it slides.

#include <locograph/core/augmented_lagrangian.h>
#include <locograph/planners/online/detour_search.h>
#include <locograph/planners/online/window_quality.h>
#include <locograph/planners/plan/plan.h>

#include <memory>
#include <optional>

namespace locograph {

struct LocalPlannerOptions {
  int horizon = 20;
  double deadline_s = 0.0;      ///< for one cycle; 0: none
  int max_iterations = 15;      ///< of one optimisation
  int max_rounds = 3;           ///< of the augmented Lagrangian, after the first optimisation
  double raise = 10.0;          ///< growth of a penalty from round to round
  double max_raise = 1e4;       ///< to which they grow, in all cycles together
  double gain = 1e-3;           ///< see OptimiserOptions
  double feasible_gain = 0.03;  ///< of one iteration that ends in a feasible window: enough
  double blocked_m = 0.05;      ///< behind the plan at the end of the window: look for a detour
  int detour_pause = 4;         ///< cycles to wait after a detour that did not help at once
  DetourOptions detour;

  void validate() const;
};

struct CycleReport {
  int executed = 0;
  int window = 0;              ///< configurations freed
  bool feasible = false;       ///< the whole window
  bool next_feasible = false;  ///< the configuration that is executed next, and the way to it
  int feasible_steps = 0;      ///< of the window, before the first violation
  /// The worst one of the first step that violates any, and the configuration that this leads to.
  std::optional<ConstraintViolation> violation;
  int violated_at = -1;  ///< index in the plan
  int constraints = 0;   ///< edges of the window that were looked at
  int iterations = 0;
  int rounds = 0;
  bool detour = false;  ///< a detour was searched
  bool deadline_missed = false;
  /// Seconds: the cycle, its longest iteration, and its phases.
  double time_total = 0.0, time_iteration = 0.0, time_compile = 0.0, time_optimise = 0.0;
  double time_detour = 0.0, time_check = 0.0, time_linearise = 0.0, time_solve = 0.0;
  double time_evaluate = 0.0;
};

class LocalPlanner {
 public:
  /// The graph must outlive the planner. Throws Error for a graph without a plan, for one that
  /// leaves its wheels, and for options out of range.
  LocalPlanner(Graph& graph, const LocalPlannerOptions& options);
  ~LocalPlanner();

  int plan_size() const { return static_cast<int>(plan_.slots.size()); }
  const Plan& plan() const { return plan_; }
  const Problem& compiled_window() const { return problem_; }  ///< of the last cycle
  int dimension_of_configuration() const { return plan_.robot->robot->tangent_size(); }

  /// What the distance edges see from now on.
  void show(const WorldDistance& world);

  /// How far a configuration is behind its place in the plan as it came, along its heading [m].
  double behind_m(int index) const;
  /// Configurations as the plan came.
  const std::vector<Eigen::VectorXd>& planned() const { return planned_; }

  /// executed: index in the plan of the configuration the robot is at.
  CycleReport cycle(int executed);

 private:
  struct Multiplier;

  Eigen::VectorXd go_on(int i, const Eigen::VectorXd& last,
                        const Eigen::VectorXd* before_last) const;
  bool gained_little() const;
  bool good_enough() const;
  void learn_lambda(double& lambda);
  void enter(int executed, int last);
  void gather_window(int executed, int last);
  int configuration_of(int slot) const;
  void compile(CycleReport& report);
  void restore_multipliers();
  void keep_multipliers();
  WindowQuality read(double cost) const;
  bool take_if_better(const WindowQuality& quality);
  void store_best();
  bool optimise(CycleReport& report, const Deadline& deadline, double& lambda);
  void search_detour(CycleReport& report, const Deadline& deadline);
  void wait_with_detours(const CycleReport& report);
  bool apply_detour(const CycleReport& report, const Deadline& deadline);
  void raise_constraints(CycleReport& report, const Deadline& deadline);
  void load_unfinished(const CycleReport& report);
  void keep_unfinished(const CycleReport& report);
  Eigen::Map<Eigen::VectorXd> configuration(int index);
  Eigen::Map<const Eigen::VectorXd> configuration(int index) const;
  bool is_fixed(int index) const { return graph_.vertex_record(plan_.slots[index]).fixed; }

  Graph& graph_;
  LocalPlannerOptions options_;
  Plan plan_;
  std::vector<Eigen::VectorXd> planned_;  ///< configurations as the plan came
  int detour_not_before_ = 0;             ///< executed index; see detour_pause
  bool detour_due_ = false;               ///< a deadline left no time for one: first of all, then
  int entered_ = 0;                       ///< last index that has been in a window
  Problem problem_;
  Workspace workspace_;
  ConstraintReader reader_;
  std::unique_ptr<LinearSolver> solver_;
  Optimiser optimiser_;
  double lambda_;        ///< that a cycle begins with, in units of the largest diagonal entry
  double lambda_aside_;  ///< the same for what is not handed out yet
  std::vector<double> diagonal_;
  DetourSearch detour_;
  std::vector<int> window_, held_;
  std::vector<int> step_of_;      ///< of the constraints, see window_quality()
  int steps_ = 0;                 ///< of the window
  WindowQuality best_, nearest_;  ///< of this cycle: what is handed out; what violates least
  std::vector<double> best_state_, nearest_state_;
  bool cut_short_ = false;                   ///< the last optimisation, by the deadline
  bool first_iteration_ = true;              ///< of the cycle: no deadline prevents it
  std::vector<Eigen::VectorXd> unfinished_;  ///< what was worse than what was handed out, by index
  int unfinished_end_ = 0;                   ///< one behind its last configuration; 0: none
  std::vector<Multiplier> multipliers_;      ///< by edge slot, ascending
};

}  // namespace locograph
