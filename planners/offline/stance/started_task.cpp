#include <locograph/check/judge.h>
#include <locograph/planners/offline/stance/stance_space.h>
#include <locograph/planners/offline/stance/started_task.h>
#include <locograph/planners/posture/posture_solver.h>
#include <locograph/planners/scenario/contact_place.h>
#include <locograph/planners/task/task_stances.h>
#include <locograph/robots/robot_state.h>

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

void require_sound_goals(const Scenario& scenario, const Task& task) {
  for (std::size_t g = 0; g < task.goals.size(); ++g) {
    blame_line(scenario, scenario.contacts->goal_lines[g], [&] {
      require_sound_stance(*task.robot->robot, task.goals[g]);
      for (const Contact& contact : task.goals[g].contacts) {
        if (lies_on_something(task.world->world(), contact)) continue;
        throw Error("the contact of " + contact.name() + " touches nothing (" +
                        nearest_place(task.world->world(), contact) + ")",
                    "one on a surface or a bar of the environment");
      }
    });
  }
}

/// Soles whose direction in their plane is left open are held and put down as the robot has them at
/// its start: a sole that is held does not turn from one transition to the next.
void direct_soles(Task& task) {
  constexpr double kLeast = 1e-3;  // of a unit vector along the plane
  RobotState state(*task.robot->robot);
  state.update(task.start_configuration.data());
  const auto direct = [&](Contact& contact) {
    const EndEffector& sole = contact.effector;
    if (sole.kind != ContactKind::kSurface || contact.forward) return;
    const int link = task.robot->robot->link_index(sole.link);
    const Eigen::Vector3d along = state.world_from_link(link).linear() * axes_in_link(sole).col(0);
    const Eigen::Vector3d normal = contact.normal.normalized();
    const Eigen::Vector3d forward = along - along.dot(normal) * normal;
    if (forward.norm() > kLeast) contact.forward = forward.normalized();
  };
  std::ranges::for_each(task.start.contacts, direct);
  for (Stance& goal : task.goals) std::ranges::for_each(goal.contacts, direct);
}

/// Finds a configuration that stands at the start, the given one if it does. Returns why there is
/// none; empty: found.
std::string find_start(const Judge& judge, const Eigen::VectorXd& given, const Deadline& deadline,
                       StartedTask& started) {
  Task& task = started.task;
  task.start_configuration = given;
  const CheckReport as_given = judge.check(given, task.start, task.check);
  if (as_given.feasible) return "";
  const StancePlannerOptions options;
  Task bare = task;
  bare.margin = ExecutionMargin::none();
  StanceSpace keeping(task, options), giving_up(bare, options);
  std::string reason;
  // A start that has no margin is taken all the same.
  const int with = task.margin == bare.margin ? 0 : kMostAttempts;
  for (int attempt = 0; attempt < with + kMostAttempts; ++attempt) {
    if (attempt > 0) deadline.require();
    const StanceSpace::Attempt found = attempt < with
                                           ? keeping.stand(task.start, given, attempt)
                                           : giving_up.stand(task.start, given, attempt - with);
    if (!found.found) {
      if (reason.empty()) reason = found.reason;
      continue;
    }
    const CheckReport report = judge.check(found.configuration, task.start, task.check);
    if (!report.feasible) {
      reason = violation_text(report.worst());
      continue;
    }
    task.start_configuration = found.configuration;
    started.moved_base_m = (found.configuration.head<3>() - given.head<3>()).norm();
    started.moved_joint_rad = (found.configuration - given)
                                  .tail(task.robot->robot->active_joint_count())
                                  .cwiseAbs()
                                  .maxCoeff();
    return "";
  }
  return reason + "; as given, " + violation_text(as_given.worst());
}

}  // namespace

StartedTask started_task(const Scenario& scenario, const ContactMoves& moves,
                         const Deadline& deadline) {
  if (!scenario.contacts)
    throw Error(scenario.source, 0, "no <start> and <goal>", "a contact task");
  const int start_line = scenario.contacts->start_line;
  StartedTask started;
  Task& task = started.task;
  task = task_of(scenario, deadline);
  const Robot& robot = *task.robot->robot;
  for (std::size_t e = 0; e < scenario.end_effectors.size(); ++e) {
    blame_line(scenario, scenario.end_effector_lines[e],
               [&] { require_sound_effector(robot, scenario.end_effectors[e]); });
  }
  require_sound_goals(scenario, task);
  blame_line(scenario, start_line, [&] { require_sound_stance(robot, task.start); });

  const bool moved = moves.most_m > 0.0;
  task.moves = moves;
  task.moves.draws = 1;
  if (moved) {
    task.goals = task_stances(scenario, task.end_effectors(), task.world->world(), moves).goals;
    require_sound_goals(scenario, task);
  }
  const Judge judge(task.robot->robot, task.world);
  for (;; ++task.moves.draws) {
    Eigen::VectorXd given;
    if (moved) {
      task.start =
          task_stances(scenario, task.end_effectors(), task.world->world(), task.moves).start;
    }
    blame_line(scenario, start_line, [&] {
      require_sound_stance(robot, task.start);
      given = given_configuration(scenario, robot, task.start);
    });
    const std::string reason = find_start(judge, given, deadline, started);
    if (reason.empty()) {
      direct_soles(task);
      return started;
    }
    if (moved && task.moves.draws < kMostDraws) continue;
    const bool overlaps = reason.find("self_collision") != std::string::npos;
    throw Error(scenario.source, start_line, "no configuration stands at the start: " + reason,
                overlaps && robot.srdf_file().empty()
                    ? "an SRDF that says which links may overlap, as `info --write-srdf` makes one"
                    : "contacts that can be held");
  }
}

}  // namespace locograph
