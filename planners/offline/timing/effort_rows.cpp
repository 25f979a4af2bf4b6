#include <locograph/common/error.h>
#include <locograph/planners/offline/timing/effort_rows.h>
#include <locograph/robots/dynamics.h>

#include <memory>
#include <string>

namespace locograph {
namespace {

struct JointEfforts {
  JointEfforts(const Robot& robot, double scale, const Eigen::Vector3d& gravity)
      : state(robot), dynamics(robot, gravity), limit(robot.active_joint_count()) {
    for (int i = 0; i < limit.size(); ++i) limit[i] = scale * robot.active_joint(i).max_effort;
  }

  TimingRows rows(const PathPoint& point) {
    const Eigen::VectorXd still = Eigen::VectorXd::Zero(limit.size());
    state.update(point.configuration.data());
    const Eigen::VectorXd weight = torques(still, still);
    const Eigen::VectorXd a = torques(still, point.first) - weight;
    const Eigen::VectorXd b = torques(point.first, point.second) - weight;
    TimingRows result;
    for (Eigen::VectorXd* part : {&result.a, &result.b, &result.c}) part->resize(2 * limit.size());
    result.a << a, -a;
    result.b << b, -b;
    result.c << limit - weight, limit + weight;
    return result;
  }

  Eigen::VectorXd torques(const Eigen::VectorXd& velocity, const Eigen::VectorXd& acceleration) {
    Eigen::VectorXd result(limit.size());
    dynamics.inverse_dynamics(state, velocity, acceleration, {}, result);
    return result;
  }

  RobotState state;
  RobotDynamics dynamics;
  Eigen::VectorXd limit;
};

}  // namespace

TimingRowsAt effort_rows(const Robot& robot, double effort_scale, const Eigen::Vector3d& gravity) {
  if (robot.floating_base()) throw Error("effort limits of a floating base", "a fixed base");
  if (!(effort_scale > 0.0)) {
    throw Error("an effort scale of " + std::to_string(effort_scale), "more than 0");
  }
  const auto efforts = std::make_shared<JointEfforts>(robot, effort_scale, gravity);
  return [efforts](const PathPoint& point) { return efforts->rows(point); };
}

}  // namespace locograph
