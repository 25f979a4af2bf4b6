#include <locograph/check/judge.h>
#include <locograph/planners/offline/stance/stance_problem.h>
#include <locograph/planners/offline/stance/stance_space.h>
#include <locograph/planners/posture/posture_solver.h>
#include <locograph/planners/scenario/contact_place.h>
#include <locograph/planners/scenario/task_stances.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

constexpr int kMostAttempts = 4;

/// Runs f; what it throws is the fault of a line of the scenario.
template <class F>
void blame_line(const Scenario& scenario, int line, F&& f) {
  try {
    f();
  } catch (const Error& error) {
    if (error.file() == scenario.source) throw;
    throw Error(scenario.source, line, error.what(), "");
  }
}

Eigen::VectorXd given_configuration(const Scenario& scenario, const Robot& robot,
                                    const Stance& start) {
  const ContactTask& task = *scenario.contacts;
  const std::vector<std::string> states = robot.configuration_names();
  const bool known = std::find(states.begin(), states.end(), scenario.start_state) != states.end();
  if (!known && scenario.start_state != "home") {
    throw Error("unknown state '" + scenario.start_state + "'", "a group state of the SRDF");
  }
  Eigen::VectorXd q =
      known ? robot.named_configuration(scenario.start_state) : robot.neutral_configuration();
  for (const GivenJoint& given : task.joints) {
    blame_line(scenario, given.line, [&] {
      const Joint& joint = robot.joints()[static_cast<std::size_t>(robot.joint_index(given.name))];
      if (joint.index < 0) throw Error("joint " + given.name + " does not move", "an active joint");
      q[robot.base_configuration_size() + joint.index] = given.position;
    });
  }
  if (task.base) {
    q.head<7>() = *task.base;
  } else {
    q = placed_at(robot, q, start);
  }
  return q;
}

/// The scenario's task as it says it, without a start configuration.
StanceProblem problem_of(const Scenario& scenario, const Deadline& deadline) {
  StanceProblem problem;
  problem.robot =
      std::make_shared<const RobotParameter>(scenario.urdf, scenario.srdf, scenario.robot);
  problem.robot->robot->require_collision_shapes();
  problem.world = world_of(scenario, deadline);
  problem.end_effectors = scenario.end_effectors;
  TaskStances task = task_stances(scenario, problem.world);
  problem.start = std::move(task.start);
  problem.goals = std::move(task.goals);
  problem.check.known = scenario.end_effectors;
  problem.check.enforce_torque_limits = scenario.enforce_torque_limits;
  problem.check.effort_scale = scenario.effort_scale;
  problem.check.base_linear_m_s = scenario.limits.base_linear_m_s;
  problem.check.base_angular_rad_s = scenario.limits.base_angular_rad_s;
  problem.check.joint_acceleration_rad_s2 = scenario.limits.joint_acceleration_rad_s2;
  return problem;
}

void require_sound_goals(const Scenario& scenario, const StanceProblem& problem) {
  for (std::size_t g = 0; g < problem.goals.size(); ++g) {
    blame_line(scenario, scenario.contacts->goal_lines[g], [&] {
      require_sound_stance(*problem.robot->robot, problem.goals[g]);
      for (const Contact& contact : problem.goals[g].contacts) {
        if (lies_on_something(problem.world, contact)) continue;
        throw Error("the contact of " + contact.name() + " touches nothing",
                    "one on a surface or a bar of the environment");
      }
    });
  }
}

/// Finds a configuration that stands at the start, the given one if it does. Returns why there is
/// none; empty: found.
std::string find_start(const Judge& judge, const Eigen::VectorXd& given, const Deadline& deadline,
                       StartedProblem& started) {
  StanceProblem& problem = started.problem;
  problem.start_configuration = given;
  const CheckReport as_given = judge.check(given, problem.start, problem.check);
  if (as_given.feasible) return "";
  const StancePlannerOptions options;
  StanceSpace space(problem, options);
  std::string reason;
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    if (attempt > 0) deadline.require();
    const StanceSpace::Attempt found = space.stand(problem.start, given, attempt);
    if (!found.found) {
      if (reason.empty()) reason = found.reason;
      continue;
    }
    const CheckReport report = judge.check(found.configuration, problem.start, problem.check);
    if (!report.feasible) {
      reason = violation_text(report.worst());
      continue;
    }
    problem.start_configuration = found.configuration;
    started.moved_base_m = (found.configuration.head<3>() - given.head<3>()).norm();
    started.moved_joint_rad = (found.configuration - given)
                                  .tail(problem.robot->robot->active_joint_count())
                                  .cwiseAbs()
                                  .maxCoeff();
    return "";
  }
  return reason + "; as given, " + violation_text(as_given.worst());
}

}  // namespace

StartedProblem stance_problem(const Scenario& scenario, const ContactMoves& moves,
                              const Deadline& deadline) {
  if (!scenario.contacts)
    throw Error(scenario.source, 0, "no <start> and <goal>", "a contact task");
  const int start_line = scenario.contacts->start_line;
  StartedProblem started;
  StanceProblem& problem = started.problem;
  problem = problem_of(scenario, deadline);
  const Robot& robot = *problem.robot->robot;
  require_camera_links(scenario, robot);
  for (std::size_t e = 0; e < scenario.end_effectors.size(); ++e) {
    blame_line(scenario, scenario.end_effector_lines[e],
               [&] { require_sound_effector(robot, scenario.end_effectors[e]); });
  }
  require_sound_goals(scenario, problem);
  blame_line(scenario, start_line, [&] { require_sound_stance(robot, problem.start); });

  const bool moved = moves.most_m > 0.0;
  problem.moves = moves;
  problem.moves.draws = 1;
  if (moved) {
    problem.goals = task_stances(scenario, problem.world, moves).goals;
    require_sound_goals(scenario, problem);
  }
  const Judge judge(problem.robot->robot, problem.world);
  for (;; ++problem.moves.draws) {
    Eigen::VectorXd given;
    if (moved) problem.start = task_stances(scenario, problem.world, problem.moves).start;
    blame_line(scenario, start_line, [&] {
      require_sound_stance(robot, problem.start);
      given = given_configuration(scenario, robot, problem.start);
    });
    const std::string reason = find_start(judge, given, deadline, started);
    if (reason.empty()) return started;
    if (moved && problem.moves.draws < kMostDraws) continue;
    throw Error(scenario.source, start_line, "no configuration stands at the start: " + reason,
                "contacts that can be held");
  }
}

}  // namespace locograph
