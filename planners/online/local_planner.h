#pragma once
/// The online planner: keeps the next configurations of a plan valid while the world changes.
///
///     LocalPlanner planner(plan_graph, options);
///     for (int executed = 0; executed + 1 < planner.plan_size(); ++executed) {
///       planner.show(snapshot);                         // what the sensors see now; optional
///       planner.measure(configuration);                 // where the robot is; optional
///       CycleReport cycle = planner.cycle(executed);    // refines executed + 1 … executed + H
///       if (!cycle.next_feasible) break;                // stop: the robot stays where it is
///     }
///
/// A cycle moves the window (window.h) to the H configurations after the executed one, initialises
/// those that enter it (warm_start.h) and goes on with the search for a better one, step by step:
///
///   1. optimise from the window that the last cycle handed out (window_solver.h)
///   2. if constraints are still violated, or the window falls behind the plan: ask proposals
///      (proposal.h), such as a detour, and optimise from what they find
///   3. raise the constraints that are violated after that
///   4. give each of LocalPlannerOptions::fallbacks a try of its own
///
/// One iteration of the optimiser is a step, or a slice of a proposal, or that the window is moved
/// where most cycles do not move it. A termination that counts
/// iterations ends a cycle after so many steps, whatever they were, and the next cycle goes on from
/// there, in a world that is new as well: at 50 cycles of one step for each second of the plan no
/// cycle takes longer than its longest step. Without a termination a cycle goes through to the end.
///
/// Constraints are whatever the edges of the graph say (core/violations.h), those of plug-ins too.
/// The graph is only given a window that is better than the one it had (incumbent.h). Constraints
/// that cannot be met are reported, with place and size; no window that violates one is reported as
/// feasible.
///
/// The window is compiled when it moves, not once a cycle. A search that is over is not begun again
/// until the configuration or the world is another one: cycles give its answer again.
///
/// Time and memory of a cycle depend on H, not on the length of the plan.

#include <locograph/planners/online/incumbent.h>
#include <locograph/planners/online/proposal_schedule.h>
#include <locograph/planners/online/standard_proposals.h>
#include <locograph/planners/online/warm_start.h>
#include <locograph/planners/online/window_solver.h>

#include <limits>
#include <memory>
#include <mutex>
#include <vector>

namespace locograph {

struct LocalPlannerOptions {
  int horizon = 20;        ///< H
  double horizon_s = 0.0;  ///< above 0 it counts instead, see Horizon::seconds
  WindowSolverOptions solver;
  std::vector<ProposalFactory> proposals = standard_proposals();
  /// Proposals too, asked one after the other in cycles that have found no feasible window. Their
  /// constraints are raised from where each of them leads.
  std::vector<ProposalFactory> fallbacks = {};
  double blocked_m = 0.05;  ///< behind the plan at the end of the window: ask proposals
  int proposal_pause = 4;   ///< cycles to wait after proposals that did not help at once

  /// Throws Error naming the option that is out of range.
  void validate() const;
};

class LocalPlanner {
 public:
  /// The graph must outlive the planner. Throws Error for what OnlinePlan refuses, and for options
  /// out of range.
  LocalPlanner(Graph& graph, const LocalPlannerOptions& options);

  /// The world that edges and proposals see from the next cycle on; the last one that is shown
  /// before it counts. Other threads may show while a cycle runs, which keeps the one it began
  /// with. Not null. The snapshot's distance() is made here, lest a cycle wait for it. Throws Error
  /// for one that is older than the last one.
  void show(std::shared_ptr<const WorldSnapshot> world);

  /// Where the robot is, at the configuration of the next cycle: a configuration of its plan, as
  /// the robot's sensors tell it. The plan has it from then on, contacts that are elsewhere too
  /// (OnlinePlan::take_contacts()), and the window leads back to where it was planned, within
  /// limits. As show(): the last one counts, other threads may call it. Throws Error for another
  /// size, for what is not finite, and for an attitude that is none.
  void measure(const Eigen::VectorXd& configuration);

  /// The window of a configuration before any search, in the graph: as planned, or as it leads back
  /// from what was measured. Whether it is feasible. The next cycle takes it up.
  bool begin_window(int executed);

  /// executed: index in the plan of the configuration the robot is at.
  /// Allocates nothing on wheels after the first cycles, as long as the window has as many
  /// configurations and the stance is the same.
  CycleReport cycle(int executed, const Termination& termination = {});
  /// Puts the last cycle's answer into words, where its window is not feasible: reason, violation.
  void explain(CycleReport& last) const;

  /// Something of the graph is different that no vertex's state says, such as times, weights or
  /// parameters: what is known of the window does not hold any more.
  void plan_changed() { changed_ = true; }

  int plan_size() const { return plan_.size(); }
  const Plan& plan() const { return plan_.plan(); }
  /// The plan as it came, and as it is now.
  const OnlinePlan& online_plan() const { return plan_; }
  /// Of a cycle at an executed configuration: the last configuration of its window.
  int last_of_window(int executed) const { return window_.last_after(executed); }
  const Problem& compiled_window() const { return solver_.problem(); }  ///< of the last cycle

 private:
  /// What the search goes on with.
  enum class Phase {
    kOptimise,  ///< from what was handed out
    kPropose,
    kFollow,  ///< what a proposal has found
    kRaise,
    kFallBack,
    kFollowFallback,
    kRaiseFallback,
    kOver,
  };

  bool take_shown();
  void require_step(int executed) const;
  Eigen::VectorXd take_measured();
  bool tries_again();
  void begin(CycleReport& report, bool moved, const Eigen::VectorXd& measured);
  const std::vector<double>* leftover();
  bool move_window(int executed, const Eigen::VectorXd& measured);
  void see_new_world();
  int improve(CycleReport& report, const Termination& termination);
  int improve_after_move(CycleReport& report, const Termination& termination);
  void rest_if_as_planned();
  bool advance(CycleReport& report, const Termination& termination);
  bool run(CycleReport& report, const Termination& termination);
  void end_run();
  void end_fallback();
  bool propose(CycleReport& report, const Termination& termination);
  void go_on_after_proposals();
  void raise_or_fall_back();
  void fall_back();
  void enter(Phase phase);
  bool is_good();
  bool is_as_planned() const;
  bool wants_proposals();
  bool offer();
  void hand_out_best();
  void describe_best(CycleReport& report) const;

  LocalPlannerOptions options_;
  OnlinePlan plan_;
  Window window_;
  WarmStart warm_start_;
  WindowSolver solver_;
  Incumbent incumbent_;
  Incumbent beside_;  ///< what a fallback has led to
  ProposalSchedule proposals_, fallbacks_;
  std::vector<Eigen::VectorXd> candidate_;  ///< a proposal's
  Phase phase_ = Phase::kOptimise;
  int asked_ = 0;           ///< proposals or fallbacks, of this search
  int iterations_ = 0;      ///< of this phase
  bool helped_ = false;     ///< proposals
  bool left_over_ = false;  ///< the search began with a window that the one before had left
  bool better_ = false;     ///< the incumbent, than what was handed out
  bool changed_ = false;    ///< see plan_changed()
  int rested_ = 0;          ///< cycles since the window was moved
  int revision_ = 0;        ///< of the plan that was compiled last
  std::vector<double> handed_out_, least_;  ///< see see_new_world()
  CycleReport answer_;                      ///< of the last cycle
  WindowQuality tried_;                     ///< what the last search at this configuration led to
  std::mutex showing_;
  std::shared_ptr<const WorldParameter> shown_;  ///< since the last cycle began; null: none
  double shown_stamp_s_ = -std::numeric_limits<double>::infinity();  ///< of the last one
  Eigen::VectorXd measured_;                                         ///< likewise; empty: none
};

}  // namespace locograph
