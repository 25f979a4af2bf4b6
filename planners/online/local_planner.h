#pragma once
/// The online planner: keeps the next configurations of a plan valid while the world changes.
///
///     LocalPlanner planner(plan_graph, options);
///     for (int executed = 0; executed + 1 < planner.plan_size(); ++executed) {
///       planner.show(snapshot);                         // what the sensors see now; optional
///       CycleReport cycle = planner.cycle(executed);    // refines executed + 1 … executed + H
///       if (!cycle.next_feasible) break;                // stop: the robot stays where it is
///     }
///
/// A cycle moves the window (window.h) to the H configurations after the executed one, initialises
/// those that enter it (warm_start.h) and optimises it (window_solver.h). If constraints are still
/// violated, or the window falls behind the plan, it asks proposals (proposal.h), such as a detour,
/// and optimises from what they find. Constraints that are violated after that are raised. Where
/// they are violated still, each of LocalPlannerOptions::fallbacks has a try of its own.
///
/// Constraints are whatever the edges of the graph say (core/violations.h), those of plug-ins too.
/// The graph is only given a window that is better than the one it had (incumbent.h), also when the
/// termination ends the cycle; the next cycle then continues from the unfinished window. A cycle
/// ends at most one iteration after that. Constraints that cannot be met are reported, with
/// place and size; no window that violates one is reported as feasible.
///
/// A cycle that got nothing better out of an infeasible window than the one before it, at the same
/// configuration and in the same world, is the last that tries: until one of them changes, cycles
/// give its answer again.
///
/// Time and memory of a cycle depend on H, not on the length of the plan.

#include <locograph/planners/online/proposal_schedule.h>
#include <locograph/planners/online/standard_proposals.h>
#include <locograph/planners/online/warm_start.h>
#include <locograph/planners/online/window_solver.h>

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
  /// with. Not null. The snapshot's distance() is made here, lest a cycle wait for it.
  void show(std::shared_ptr<const WorldSnapshot> world);

  /// executed: index in the plan of the configuration the robot is at.
  CycleReport cycle(int executed, const Termination& termination = {});

  int plan_size() const { return plan_.size(); }
  const Plan& plan() const { return plan_.plan(); }
  /// The plan as it came, and as it is now.
  const OnlinePlan& online_plan() const { return plan_; }
  /// Of a cycle at an executed configuration: the last configuration of its window.
  int last_of_window(int executed) const { return window_.last_after(executed); }
  const Problem& compiled_window() const { return solver_.problem(); }  ///< of the last cycle

 private:
  bool take_shown();
  void begin(CycleReport& report);
  bool improve(CycleReport& report, const Termination& termination);
  bool load_unfinished();
  bool is_as_planned() const;
  bool wants_proposals(bool continued) const;
  bool try_proposals(CycleReport& report, const Termination& termination);
  bool try_fallbacks(CycleReport& report, const Termination& termination);
  Proposal::Answer ask(ProposalSchedule& proposals, CycleReport& report,
                       const Termination& termination);
  void keep_unfinished(bool cut_short);
  void hand_out_best();
  void describe_best(CycleReport& report) const;
  void keep_answer(const CycleReport& report, bool cut_short);

  LocalPlannerOptions options_;
  OnlinePlan plan_;
  Window window_;
  WarmStart warm_start_;
  WindowSolver solver_;
  Incumbent incumbent_;
  Incumbent beside_;  ///< what a fallback has led to
  ProposalSchedule proposals_, fallbacks_;
  std::vector<Eigen::VectorXd> candidate_;  ///< a proposal's
  CycleReport answer_;                      ///< of the last cycle
  WindowQuality quality_;                   ///< what it handed out
  bool new_world_ = true;                   ///< since the cycle before
  bool settled_ = false;                    ///< nothing better is found at the same configuration
  std::mutex showing_;
  std::shared_ptr<const WorldSnapshot> shown_;  ///< since the last cycle began; null: none
};

}  // namespace locograph
