#include <locograph/check/judge.h>
#include <locograph/common/input_file.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/posture/contacts_file.h>
#include <locograph/planners/scenario/scenario.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/world/octree.h>

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
std::shared_ptr<const Robot> robot_of(const Scenario& scenario,
                                      const std::shared_ptr<const Robot>& own) {
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
    return own;
  }
  auto robot =
      std::make_shared<const Robot>(Robot::load(scenario.urdf, scenario.srdf, scenario.robot));
  if (robot->floating_base() != own->floating_base()) {
    throw Error(names_robot + ", is " + (own->floating_base() ? "floating" : "fixed") +
                    ", that of the scenario " + scenario.source + " is not",
                robot->floating_base() ? "floating" : "fixed");
  }
  if (active_names(*robot) != active_names(*own)) {
    throw Error(names_robot + ", moves other joints than that of the scenario " + scenario.source,
                "the same active joints");
  }
  return robot;
}

void take_word_of(const Scenario& scenario, CheckOptions& options) {
  options.known = scenario.end_effectors;
  options.base_linear_m_s = scenario.limits.base_linear_m_s;
  options.base_angular_rad_s = scenario.limits.base_angular_rad_s;
  options.joint_acceleration_rad_s2 = scenario.limits.joint_acceleration_rad_s2;
  options.enforce_torque_limits = scenario.enforce_torque_limits;
  options.effort_scale = scenario.effort_scale;
}

/// What PARAMS_WORLD names and the scenario does not.
void add_plan_world(const WorldParameter& seen, const Scenario* scenario, World& world) {
  const bool same_map = scenario != nullptr && same_file(seen.map, scenario->map);
  const bool same_obstacles = scenario != nullptr && same_file(seen.obstacles, scenario->obstacles);
  const World more =
      load_world(same_map ? fs::path() : seen.map, same_obstacles ? fs::path() : seen.obstacles);
  if (more.map) world.map = world.map ? joined(*world.map, *more.map) : more.map;
  world.obstacles.insert(world.obstacles.end(), more.obstacles.begin(), more.obstacles.end());
}

}  // namespace

Judging judging_of(const Graph& graph, const Plan& plan, const JudgingRequest& request) {
  const auto origin = graph.parameters().find<ScenarioParameter>();
  const auto contacts = graph.parameters().find<ContactsParameter>();
  if (origin && contacts) {
    throw Error("a plan with both a PARAMS_SCENARIO and a PARAMS_CONTACTS", "one of them");
  }
  Judging judging;
  judging.robot = plan.robot->robot;
  std::optional<Scenario> scenario;
  const bool other = !request.scenario.empty();
  if (other || origin) {
    scenario = load_scenario(other ? request.scenario : origin->scenario, request.data_folder);
    judging.robot = robot_of(*scenario, plan.robot->robot);
    take_word_of(*scenario, judging.options);
    judging.options.compare_claims = !other;
    judging.world = world_of(*scenario);
  } else {
    judging.world.surfaces.push_back(ground());
    judging.options.surfaces_known = false;
  }
  if (contacts && !other) {
    Stance stance = load_contacts(contacts->file, *plan.robot->robot);
    for (const Contact& contact : stance.contacts)
      judging.options.known.push_back(contact.effector);
    judging.options.places = std::move(stance.contacts);
  }
  if (!request.map.empty() || !request.obstacles.empty()) {
    World instead = load_world(request.map, request.obstacles);
    judging.world.map = std::move(instead.map);
    judging.world.obstacles = std::move(instead.obstacles);
  } else if (plan.world && !other) {
    add_plan_world(*plan.world, scenario ? &*scenario : nullptr, judging.world);
  }
  return judging;
}

CheckReport judged(const Graph& graph, const Plan& plan, const Judging& judging) {
  return *judged(motion_of(graph, plan), judging, JobControl());
}

std::optional<CheckReport> judged(const Motion& motion, const Judging& judging,
                                  const JobControl& job) {
  const Judge judge(judging.robot, judging.world);
  const bool posture = motion.configurations.size() == 1 && motion.stance_from.front() >= 0;
  if (!posture) return judge.check(motion, judging.options, job);
  return judge.check(motion.configurations.front(), motion.stances.front(), judging.options);
}

}  // namespace locograph
