#pragma once
/// By whose word a plan is judged: in which world, with what its end effectors can bear, and within
/// which limits.
///
///     JudgingRequest request{.data_folder = data_folder};
///     const Judging judging = judging_of(graph, plan, request);
///     const CheckReport report = judged(graph, plan, judging);
///
/// A plan does not vouch for itself. The robot, its limits and the pairs of links that may meet are
/// its scenario's; what is in the way and what may be touched is its scenario's
/// own environment, and what its PARAMS_WORLD adds; what end effectors can bear is the word of the
/// scenario or of the contacts file. A plan that names neither stands on the plane z = 0 among what
/// its PARAMS_WORLD names, and what it says of its contacts is taken on trust, which the report
/// tells. How high the ground is is the scenario's word, too, else z = 0: a plan whose PARAMS_WORLD
/// says otherwise is refused with its line. A contacts file says where contacts are but nothing of
/// surfaces: the ground is z = 0, and that there is something to touch at the other places is taken
/// on trust.
///
/// A plan that names a scenario begins at the start and gets to the goals of the scenario that it
/// is judged by. One that says that its contacts are moved (PARAMS_PLAN) is held against the start
/// and the goals moved in the same way, which the report tells.

#include <locograph/check/check_report.h>
#include <locograph/check/plan_ends.h>
#include <locograph/common/job_control.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/task/task.h>
#include <locograph/robots/robot.h>
#include <locograph/world/world_snapshot.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace locograph {

struct JudgingRequest {
  /// A scenario to judge in instead of the plan's own: its world, its friction, its limits, its
  /// start and goals. Claims of the plan are then not compared with it.
  std::string scenario = {};
  /// The task of the plan's own scenario where that is loaded already; null: it is loaded.
  std::shared_ptr<const Task> task = nullptr;
  /// Instead of what is in the way, surfaces aside; both empty: as it is.
  std::filesystem::path map = {}, obstacles = {};
  Deadline deadline = {};  ///< see world_of()
  /// See load_scenario().
  std::filesystem::path data_folder;
};

struct Judging {
  std::shared_ptr<const Robot> robot;  ///< the scenario's, whatever the plan says of its own
  std::shared_ptr<const WorldSnapshot> world;
  CheckOptions options;
  std::shared_ptr<const Task> task;  ///< by whose word; null: no one's
  std::optional<PlannedTask> ends;   ///< of a plan that names a scenario: where `task` has them
  ContactMoves moves;                ///< by the plan's word, of the contacts of the task
  bool incomplete = false;           ///< by its word: goals are told, and not judged
};

/// Throws Error for files that cannot be used, for a plan that names both a scenario and a contacts
/// file, and for a plan of another robot than the scenario's, or one that moves other joints.
Judging judging_of(const Graph& graph, const Plan& plan, const JudgingRequest& request);

/// Of a plan that was made for this task just now: whole, and as it is.
Judging judging_of(std::shared_ptr<const Task> task);

/// A posture, one configuration that stands, is judged as PostureSolver does; others as motions. To
/// what the judge says are added `scenario_start` and `scenario_goals`, see check/plan_ends.h.
CheckReport judged(const Graph& graph, const Plan& plan, const Judging& judging);
/// The same of motion_of(graph, plan); nothing when the job ends before the check does.
std::optional<CheckReport> judged(const Motion& motion, const Judging& judging,
                                  const JobControl& job);

/// The check of single steps of a plan, as walk_plan() wants it.
std::function<CheckReport(const Motion&)> step_check(const Judging& judging);

/// Why a motion is not all that its scenario asks for; empty: it gets to all goals, or no scenario
/// is known and the plan does not say that it is incomplete.
std::string missed_goals(const Motion& motion, const Judging& judging);

}  // namespace locograph
