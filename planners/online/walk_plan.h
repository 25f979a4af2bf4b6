#pragma once
/// A simulation that uses the local planner: walks along a plan as if a robot executed it, with a
/// cycle of the planner or more at each step. The command `refine`.
///
///     WalkOptions options;
///     options.verify = [&](const Motion& step) { return judge.check(step, limits); };
///     WalkReport report = walk_plan(graph, world_seen_at, options);
///
/// On legs the robot begins to come to rest kDecide_s before what it finds no way past, as long as
/// forces allow; on wheels, and where there is no time for that, it is as if it had braked before.
/// Stops before a configuration that cannot be made feasible: the rest of the plan is removed from
/// the graph, which is marked as incomplete (plan_parameters.h), and the report tells the obstacle
/// (window_cause.h) and how far the robot got. A plan that is feasible but does not end at its
/// goal, whether short of it or beside it, is no success.

#include <locograph/check/check_report.h>
#include <locograph/check/limits.h>
#include <locograph/check/motion.h>
#include <locograph/planners/online/local_planner.h>

#include <functional>
#include <memory>
#include <optional>

namespace locograph {

inline constexpr double kMostRate_Hz = 1e5;  ///< of WalkOptions::rate_hz

struct WalkOptions {
  LocalPlannerOptions planner = {};
  /// Cycles in a second of the plan: one for each step at least, and no more than that when 0.
  double rate_hz = 0.0;
  /// How far from where it was planned the last configuration's base may end, in any direction.
  /// A plan that ends further away than the judge takes for a goal (limits.h) is marked incomplete.
  double goal_tolerance_m = limits::kGoal_m;
  double goal_tolerance_rad = limits::kGoal_rad;
  double cycle_deadline_s = 0.0;  ///< for one cycle; 0: none
  /// Steps of one cycle at most, see LocalPlanner; the next one goes on. 0: no limit.
  int cycle_iterations = 0;
  /// Of the walk, which ends between two cycles where the robot is.
  Termination termination = {};
  /// Asked where a robot has stopped, or on wheels has ended beside its goal: the plan as far as it
  /// was executed, and how it goes on from there (resumed_plan.h, resumed_drive.h). Nothing: the
  /// walk ends. May be empty.
  std::function<std::optional<Graph>(const Graph& stopped)> resume = {};
  int most_resumed = 5;  ///< how often
  /// Called after each cycle, e.g. to show progress; may be empty.
  std::function<void(const CycleReport&)> on_cycle = {};
  /// The independent verdict on the motion from the executed configuration to the next, before it
  /// is executed: Judge::check() in the world as it is known. The motion begins some steps earlier:
  /// only now is it known how the robot accelerates between them, and slip of wheels counts over a
  /// stretch. May be empty: then the local planner alone decides.
  std::function<CheckReport(const Motion&)> verify = {};
  /// How many times as long as planned the steps after the executed configuration are to take, 1 or
  /// more, asked after the world was shown. May be empty: as planned. Other times than planned do
  /// not go with a plan that tells its segments.
  std::function<double(int executed)> pace = {};

  /// Throws Error naming the option that is out of range.
  void validate() const;
};

/// What suits a plan: 50 cycles of one step for each second, on wheels of 20 configurations, else
/// of 2 s, as plans on legs are sampled finely for their judge.
WalkOptions walk_options_for(const Plan& plan);

struct WalkReport : PlannerAnswer {
  std::vector<CycleReport> cycles;
  std::vector<double> map_update_s;  ///< time that showing the world took, for each cycle
  std::vector<double> verify_s;      ///< time that the verdict on each step took
  int dof = 0;
  int feasible_cycles = 0;
  int deadline_misses = 0;
  std::optional<int> stopped_at;  ///< before the end of the plan
  bool at_rest = true;            ///< at the end; else no way to brake was found, see PlanWalk
  int resumed = 0;                ///< how often the plan was planned on
  int configurations = 0;         ///< left in the plan
  double short_of_goal_m = 0.0;   ///< how far the last configuration is behind where it was planned
  /// From the base of the last configuration that is left to that of the plan's goal.
  double goal_distance_m = 0.0, goal_angle_rad = 0.0;
  PlannerStatistics statistics;  ///< iterations: cycles
};

/// How far ahead of a violation of its window a robot on legs decides to stop [s].
inline constexpr double kDecide_s = 0.8;

/// The world as it is seen when the robot is at configuration `executed`; null: nothing new.
using WorldAt = std::function<std::shared_ptr<const WorldSnapshot>(int executed)>;

WalkReport walk_plan(Graph& graph, const WorldAt& world_at, const WalkOptions& options);

/// The same, a step at a time, while something carries the plan out. See walk_ahead.h.
class PlanWalk {
 public:
  /// The graph must outlive it. executed: the configuration that the robot is at. Throws Error as
  /// LocalPlanner does, for options out of range, and for a configuration that is not in the plan.
  PlanWalk(Graph& graph, WorldAt world_at, const WalkOptions& options, int executed = 0);
  ~PlanWalk();

  /// The steps up to this configuration are decided. One that has just been planned on may be less
  /// far than before.
  int executed() const;
  /// Where the robot is, see LocalPlanner::measure(), at the configuration executed(). The judge
  /// sees motions from there on. The next step is decided on after ten cycles, or as many as there
  /// are at the rate. Not across a resume.
  void measure(const Eigen::VectorXd& configuration);
  /// Decides on the next step. The plan up to the configuration `carried_out` stays as it is; a
  /// robot that cannot come to rest after it does not, and the report says so. False: the walk is
  /// over.
  bool step(int carried_out = -1);
  /// The plan as it is now, and the time in it of one of its configurations.
  Motion motion() const;
  double time_s(int configuration) const;
  WalkReport report() const;

 private:
  struct Own;
  std::unique_ptr<Own> own_;
};

}  // namespace locograph
