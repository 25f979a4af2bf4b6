#include <locograph/check/judge.h>
#include <locograph/common/input_file.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/scenario/contacts_file.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/world/distance_view.h>
#include <locograph/world/octree.h>

#include <cmath>
#include <cstdio>
#include <utility>

namespace locograph {
namespace {

namespace fs = std::filesystem;

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code unknown;
  return !a.empty() && !b.empty() && fs::equivalent(a, b, unknown);
}

std::vector<std::string> active_names(const Robot& robot) {
  std::vector<std::string> names;
  for (int i = 0; i < robot.active_joint_count(); ++i) names.push_back(robot.active_joint(i).name);
  return names;
}

/// The scenario's robot, also where the plan says less of its own: that it does not float, that
/// joints are frozen, that links may meet.
std::shared_ptr<const RobotParameter> robot_of(
    const Scenario& scenario, const std::shared_ptr<const RobotParameter>& parameter) {
  const std::shared_ptr<const Robot>& own = parameter->robot;
  const std::string names_robot = "the plan's robot, " + own->urdf_file().string();
  const bool same_urdf = same_file(own->urdf_file(), scenario.urdf);
  if (!same_urdf && read_file(own->urdf_file()) != read_file(scenario.urdf)) {
    throw Error(names_robot + ", is not the one of the scenario " + scenario.source,
                scenario.urdf.string());
  }
  const RobotOptions &ours = own->options(), &theirs = scenario.robot;
  const bool same_srdf = (own->srdf_file().empty() && scenario.srdf.empty()) ||
                         same_file(own->srdf_file(), scenario.srdf);
  if (same_urdf && same_srdf && ours.floating_base == theirs.floating_base &&
      ours.active_joints == theirs.active_joints && ours.frozen_state == theirs.frozen_state) {
    return parameter;
  }
  auto theirs_loaded =
      std::make_shared<const RobotParameter>(scenario.urdf, scenario.srdf, scenario.robot);
  const Robot& robot = *theirs_loaded->robot;
  if (robot.floating_base() != own->floating_base()) {
    throw Error(names_robot + ", is " + (own->floating_base() ? "floating" : "fixed") +
                    ", that of the scenario " + scenario.source + " is not",
                robot.floating_base() ? "floating" : "fixed");
  }
  if (active_names(robot) != active_names(*own)) {
    throw Error(names_robot + ", moves other joints than that of the scenario " + scenario.source,
                "the same active joints");
  }
  return theirs_loaded;
}

std::shared_ptr<const Task> load_task(const std::string& scenario_name, const Plan& plan,
                                      const JudgingRequest& request) {
  const Scenario scenario = load_scenario(scenario_name, request.data_folder);
  return std::make_shared<const Task>(
      task_of(scenario, robot_of(scenario, plan.robot), plan.moves, request.deadline));
}

template <class P>
int line_of(const Parameters& parameters) {
  return parameters.line(parameters.number_of<P>().value());
}

/// Of the scenario that the plan names: where that is not there, or is one of another robot, the
/// line that names it is wrong.
std::shared_ptr<const Task> own_task(const Graph& graph, const Plan& plan,
                                     const JudgingRequest& request) {
  const std::string& name = graph.parameters().find<ScenarioParameter>()->scenario;
  try {
    return load_task(name, plan, request);
  } catch (const Error& error) {
    if (error.line() > 0 || (!error.file().empty() && error.file() != name)) throw;
    throw Error("", line_of<ScenarioParameter>(graph.parameters()), error.what(), "");
  }
}

/// Worked out anew: nothing is shared with what plans drives.
PlannedTask ends_of(const DriveTask& drive) {
  const double turned = drive.curvature_1_m * drive.distance_m;
  Eigen::Vector3d end(drive.distance_m, 0.5 * turned * drive.distance_m, turned);
  if (std::abs(turned) > 1e-9) {
    end.head<2>() << std::sin(turned) / drive.curvature_1_m,
        (1.0 - std::cos(turned)) / drive.curvature_1_m;
  }
  return {.start = {},
          .goals = {{.base = end, .within_m = limits::kGoal_m, .within_rad = limits::kGoal_rad}}};
}

PlannedTask ends_of(const Task& task) {
  if (task.drive) return ends_of(*task.drive);
  PlannedTask ends{.start = {.stance = task.start}, .goals = {}};
  for (const Stance& goal : task.goals) ends.goals.push_back({.stance = goal});
  return ends;
}

/// Says of the report where the motion begins and what it gets to.
void judge_ends(const Motion& motion, const Judging& judging, CheckReport& report) {
  std::string no_start, no_goals;
  if (judging.incomplete) no_goals = "the plan says that it is incomplete";
  if (!judging.ends) no_start = no_goals = "the plan names no scenario";
  if (judging.ends) report.ends = plan_ends(motion, *judging.ends);
  for (Violation& violation :
       end_violations(motion, report.ends.value_or(PlanEnds()), no_start, no_goals)) {
    if (violation.violated) report.feasible = false;
    report.violations.push_back(std::move(violation));
  }
  if (!judging.ends || !(judging.moves.most_m > 0.0)) return;
  char moved[96];
  std::snprintf(moved, sizeof moved, "start and goals: that contacts are moved by up to %.4g m",
                judging.moves.most_m);
  report.trusted.push_back(moved);
}

/// How high the ground is does not come from the plan: one that says otherwise was planned for
/// another world.
void require_same_ground(const Graph& graph, const World& world) {
  for (const int number : graph.parameters().numbers_of<WorldParameter>()) {
    const auto seen = graph.parameters().get<WorldParameter>(number);
    if (!seen->ground_z_m) continue;
    const double ground = ground_height(world);
    constexpr double kSame_m = 1e-9;
    if (std::abs(*seen->ground_z_m - ground) <= kSame_m) continue;
    const auto text = [](double height) {
      return std::isfinite(height) ? "a ground at " + std::to_string(height) + " m"
                                   : "no ground without end";
    };
    throw Error("", graph.parameters().line(number), "PARAMS_WORLD with " + text(*seen->ground_z_m),
                "that of the world in which the plan is judged, " + text(ground));
  }
}

/// A world, and what PARAMS_WORLD names and that world's own files are not.
std::shared_ptr<const WorldSnapshot> with_plan_world(
    const std::shared_ptr<const WorldSnapshot>& own, const WorldParameter& seen) {
  const WorldFiles& files = seen.snapshot->files();
  const World& more = seen.snapshot->world();
  const bool another_map =
      more.map && !files.map.empty() && !same_file(files.map, own->files().map);
  const bool other_obstacles =
      !files.obstacles.empty() && !same_file(files.obstacles, own->files().obstacles);
  if (!another_map && !other_obstacles) return own;
  World world = own->world();
  if (another_map) world.map = world.map ? joined(*world.map, *more.map) : more.map;
  if (other_obstacles) {
    world.obstacles.insert(world.obstacles.end(), more.obstacles.begin(), more.obstacles.end());
  }
  return std::make_shared<const WorldSnapshot>(std::move(world));
}

}  // namespace

Judging judging_of(const Graph& graph, const Plan& plan, const JudgingRequest& request) {
  const auto origin = graph.parameters().find<ScenarioParameter>();
  const auto contacts = graph.parameters().find<ContactsParameter>();
  if (origin && contacts) {
    throw Error("", line_of<ContactsParameter>(graph.parameters()),
                "a plan with both a PARAMS_SCENARIO and a PARAMS_CONTACTS", "one of them");
  }
  const bool other = !request.scenario.empty();
  std::shared_ptr<const Task> task = other ? nullptr : request.task;
  if (!task && other) task = load_task(request.scenario, plan, request);
  if (!task && origin) task = own_task(graph, plan, request);
  Judging judging;
  if (task) {
    judging = judging_of(task);
    judging.options.compare_claims = !other;
    // A posture that names no scenario is part of no task.
    if (!origin && plan.slots.size() == 1) judging.ends.reset();
  } else {
    judging.robot = plan.robot->robot;
    judging.world = std::make_shared<const WorldSnapshot>(World{.surfaces = {ground()}});
    judging.options.surfaces_known = false;
  }
  judging.incomplete = plan.incomplete;
  judging.moves = plan.moves;
  if (contacts && !other) {
    Stance stance = load_contacts(contacts->file, *plan.robot->robot);
    for (const Contact& contact : stance.contacts)
      judging.options.known.push_back(contact.effector);
    judging.options.places = std::move(stance.contacts);
  }
  if (!other) require_same_ground(graph, judging.world->world());
  if (!request.map.empty() || !request.obstacles.empty()) {
    World world = judging.world->world(), instead = load_world(request.map, request.obstacles);
    world.map = std::move(instead.map);
    world.obstacles = std::move(instead.obstacles);
    judging.world = std::make_shared<const WorldSnapshot>(
        std::move(world), 0.0, WorldFiles{.map = request.map, .obstacles = request.obstacles});
  } else if (plan.world && !other) {
    judging.world = with_plan_world(judging.world, *plan.world);
  }
  return judging;
}

Judging judging_of(std::shared_ptr<const Task> task) {
  Judging judging;
  judging.robot = task->robot->robot;
  judging.world = task->world;
  judging.options = task->check;
  judging.ends = ends_of(*task);
  judging.moves = task->moves;
  judging.task = std::move(task);
  return judging;
}

CheckReport judged(const Graph& graph, const Plan& plan, const Judging& judging) {
  return *judged(motion_of(graph, plan), judging, JobControl());
}

std::optional<CheckReport> judged(const Motion& motion, const Judging& judging,
                                  const JobControl& job) {
  const Judge judge(judging.robot, judging.world);
  const bool posture =
      motion.configurations.size() == 1 && motion.stance_from.front() >= 0 && !motion.stances_only;
  std::optional<CheckReport> report =
      posture ? judge.check(motion.configurations.front(), motion.stances.front(), judging.options,
                            motion.wrenches.empty() ? StanceWrenches() : motion.wrenches.front())
              : judge.check(motion, judging.options, job);
  if (report) judge_ends(motion, judging, *report);
  return report;
}

std::function<CheckReport(const Motion&)> step_check(const Judging& judging) {
  const auto judge = std::make_shared<const Judge>(judging.robot, judging.world);
  CheckOptions options = judging.options;
  options.starts_at_rest = false;
  return [judge, options](const Motion& motion) {
    CheckOptions asked = options;
    asked.ends_at_rest = motion.slopes.empty() || motion.slopes.back().isZero(0.0);
    return judge->check(motion, asked);
  };
}

std::string missed_goals(const Motion& motion, const Judging& judging) {
  if (judging.incomplete) return "the plan says that it is incomplete";
  if (!judging.ends) return "";
  const PlanEnds ends = plan_ends(motion, *judging.ends);
  if (ends.goals_reached == ends.goals) return "";
  return "the plan does not reach goal " + std::to_string(ends.goals_reached + 1) + " of " +
         std::to_string(ends.goals) + ": " + ends.off_goal;
}

}  // namespace locograph
