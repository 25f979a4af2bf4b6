#pragma once
/// What a stance planner is asked and what it answers: a sequence of stances, one contact more or
/// less from each to the next, and a configuration for each change that is feasible for both.
///
///     const StancePlannerOptions options{.seed = 7, .max_transitions = 3000};
///     const StancePlan plan = make_stance_planner("guided")->plan(task, options);
///     const CheckReport report = judge.check(stances_motion(plan), task.check);
///
/// Success means that the judge (check/judge.h) takes the plan; wrenches are those of its
/// certificates.

#include <locograph/check/check_report.h>
#include <locograph/check/motion.h>
#include <locograph/planners/answer/planner_answer.h>

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace locograph {

/// One change of stance that a planner asked for, and what came of it.
struct TransitionAttempt {
  Stance from, to;
  Eigen::VectorXd start;        ///< the configuration it was looked for from
  Eigen::VectorXd before = {};  ///< that balls rolled from; empty: they were at their places
  int restarts = 0;             ///< at most
  bool found = false;
  double waited_s = 0.0;  ///< by the search; of little meaning with several threads
};

struct StancePlannerOptions {
  std::uint64_t seed = 0;
  Termination termination = {};
  /// That a search may use, the caller's included; a plan that ends before the deadline does not
  /// depend on it. `rrt` takes them only to shorten its way.
  int threads = 1;
  double grid_m = 0.05;  ///< between places of contacts on a surface
  /// How far an end effector gets in one move, as a part of its chain's length.
  double reach = 0.7;
  /// Transitions that may be tried for each goal; 0: no end but the termination.
  int max_transitions = 20000;
  /// Told of every transition of the search and of shortening, in their order, by the thread that
  /// plans; may be empty.
  std::function<void(const TransitionAttempt&)> observe = nullptr;
  bool keep_tree = false;  ///< StancePlan::tree is filled
  /// Balls are put only where they can come to along the normal, none in a gap as wide as itself:
  /// for stances that are to be moved between.
  bool approachable_only = false;

  /// Throws Error naming the option that is out of range.
  void validate() const;
};

/// How often something was in the way of a transition.
struct StanceFailure {
  std::string end_effector;  ///< that was to move
  std::string what;          ///< name of a TransitionFailure, or of the judge's constraint
  int count = 0;
};

/// A stance that the search tried to come to.
struct StanceTreeNode {
  Stance stance;
  int parent = -1;  ///< an earlier node; -1: a tree begins here
  bool found = false;
  bool on_way = false;  ///< to a goal, before moves were left out of that way
};

struct StanceStatistics : PlannerStatistics {
  int vertices_in_tree = 0;
  int transitions = 0, transitions_found = 0;
  double transitions_s = 0.0;  ///< that the search worked on transitions or waited for them
  double judge_s = 0.0;
};

struct StancePlan : PlannerAnswer {
  /// σ_0 … σ_N, and the configurations: the start, then that of each change, N + 1 in all.
  /// Without success as far as it got: to the goals before the one that was not reached.
  std::vector<Stance> stances;
  std::vector<Eigen::VectorXd> configurations;
  int goals_reached = 0;
  int best_contacts = 0;  ///< of the goal that was not reached: most of its contacts in one stance
  Stance best;            ///< the stance that has them
  std::vector<StanceFailure> failures;  ///< the most frequent first
  std::vector<StanceTreeNode> tree;     ///< in the order of trying, one tree after the other
  CheckReport report;                   ///< of the judge
  StanceStatistics statistics;
};

/// Stances and as many configurations as a motion that holds still, one vertex a second: what the
/// judge is asked.
Motion stances_motion(std::vector<Stance> stances, std::vector<Eigen::VectorXd> configurations);
Motion stances_motion(const StancePlan& plan);

}  // namespace locograph
