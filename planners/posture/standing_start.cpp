#include <locograph/common/error.h>
#include <locograph/planners/posture/standing_start.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/bent_legs.h>

namespace locograph {

using Eigen::Vector3d;

StandingStart standing_start(const std::shared_ptr<const RobotParameter>& robot,
                             std::vector<EndEffector> effectors, double friction,
                             const PostureOptions& options) {
  if (effectors.empty()) throw Error("a robot without end effectors", "something to stand on");
  const Robot& model = *robot->robot;
  StandingStart start;
  start.bent = bent_legs(model, effectors);
  RobotState state(model);
  state.update(start.bent.data());
  for (EndEffector& effector : effectors) {
    effector.friction = friction;
    Contact contact;
    contact.effector = effector;
    const Eigen::Isometry3d& pose = state.world_from_link(model.link_index(effector.link));
    contact.position = pose * effector.point;
    contact.position.z() = 0.0;
    if (effector.kind == ContactKind::kSurface) {
      Vector3d forward = pose.linear() * effector.forward;
      forward.z() = 0.0;
      contact.forward = forward.normalized();
    }
    contact.locked = effector.kind == ContactKind::kWheel;
    start.stance.contacts.push_back(contact);
  }
  const PostureSolver solver(robot);
  PostureProblem problem;
  problem.stance = start.stance;
  problem.preferred = placed_at(model, start.bent, start.stance);
  // As symmetric as the robot is: the solver is asked where that does not stand by itself.
  CheckReport report =
      Judge(robot->robot, posture_world()).check(problem.preferred, problem.stance, options.check);
  if (report.feasible) {
    start.answer.status = PlannerStatus::kSolved;
    start.answer.reason = "found";
    start.answer.configuration = problem.preferred;
    start.answer.report = std::move(report);
  } else {
    start.answer = solver.solve(problem, options);
  }
  return start;
}

}  // namespace locograph
