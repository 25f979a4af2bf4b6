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
/// Each cycle frees the H configurations behind the executed one and holds the rest. They start
/// from the last cycle's result; one that enters the window is moved along with the one before it.
/// A few Levenberg-Marquardt steps follow. If constraints are still violated, or the window falls
/// behind the plan, a detour is searched (detour_search.h) and optimised from there; then the
/// weights of edges that are still violated are raised for a few rounds. The better result stays.
/// Constraints that cannot be met are reported, with place and size; nothing is handed out as
/// feasible that is not.
///
/// Time and memory of a cycle depend on H, not on the length of the plan; the structure of the
/// compiled window is kept while it slides.

#include <locograph/core/optimiser.h>
#include <locograph/planners/online/detour_search.h>
#include <locograph/planners/online/window_check.h>
#include <locograph/planners/plan/plan.h>

#include <memory>

namespace locograph {

struct LocalPlannerOptions {
  int horizon = 20;
  double deadline_s = 0.0;  ///< for one cycle; 0: none
  int max_iterations = 15;  ///< of one optimisation
  int max_rounds = 3;       ///< in which violated edges gain weight
  double raise = 10.0;      ///< by which they gain it
  double gain = 1e-4;       ///< see OptimiserOptions
  double blocked_m = 0.05;  ///< behind the plan at the end of the window: look for a detour
  int detour_pause = 4;     ///< cycles to wait after a detour that did not help, unless violated
  DetourOptions detour;

  void validate() const;
};

struct CycleReport {
  int executed = 0;
  int window = 0;              ///< configurations freed
  bool feasible = false;       ///< the whole window
  bool next_feasible = false;  ///< the configuration that is executed next, and the way to it
  WindowViolation violation;   ///< the worst one, of the window
  int iterations = 0;
  int rounds = 0;
  bool detour = false;  ///< a detour was searched
  bool deadline_missed = false;
  /// Seconds: the cycle, and its phases.
  double time_total = 0.0, time_compile = 0.0, time_optimise = 0.0, time_detour = 0.0;
  double time_check = 0.0, time_linearise = 0.0, time_solve = 0.0, time_evaluate = 0.0;
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

  /// executed: index in the plan of the configuration the robot is at.
  CycleReport cycle(int executed);

 private:
  struct Attempt {
    Cost cost;
    WindowViolation violation;
  };

  void enter(int executed, int last);
  void compile(int executed, int last);
  Attempt optimise(CycleReport& report, const Deadline& deadline);
  void apply_detour(int executed, int last);
  void raise_weights();
  void restore_weights();
  Eigen::Map<Eigen::VectorXd> configuration(int index);
  Eigen::Map<const Eigen::VectorXd> configuration(int index) const;

  Graph& graph_;
  LocalPlannerOptions options_;
  Plan plan_;
  std::vector<Eigen::VectorXd> planned_;  ///< configurations as the plan came
  int detour_not_before_ = 0;             ///< executed index; see detour_pause
  int entered_ = 0;                       ///< last index that has been in a window
  Problem problem_;
  Workspace workspace_;
  std::unique_ptr<LinearSolver> solver_;
  Optimiser optimiser_;
  DetourSearch detour_;
  std::vector<int> window_, held_;
  std::vector<ViolatedEdge> violated_;
  struct RaisedWeight;
  std::vector<RaisedWeight> raised_;
};

}  // namespace locograph
