#include <locograph/common/ranges.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/record/edge_measurement.h>
#include <locograph/plugins/static_balance/static_rows.h>

#include <cmath>

namespace locograph {

template class TypedEdgePool<EdgeMeasurement>;

EdgeMeasurement::EdgeMeasurement(const Robot& robot, double plan_time_s_, Eigen::VectorXd torques_)
    : plan_time_s(plan_time_s_), torques(std::move(torques_)) {
  weights.setZero(robot.active_joint_count());
  require_rows("torques of EDGE_MEASUREMENT", torques.size(), weights.size());
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const double effort = robot.active_joint(i).max_effort;
    if (std::isfinite(effort) && effort > 0.0) weights[i] = 1.0 / (effort * effort);
  }
}

void EdgeMeasurement::bind(const Parameters& parameters) {
  require_fitting_robot(parameters, kTag, dimension(),
                        [](const RobotParameter& p) { return p.robot->active_joint_count(); });
  if (!(plan_time_s >= 0.0 && plan_time_s <= ranges::kTime_s)) {
    throw locograph::Error(
        std::string(kTag) + " of a plan's time " + std::to_string(plan_time_s) + " s",
        "0 to 1e6 s");
  }
  if (torques.size() > 0 && !(torques.cwiseAbs().maxCoeff() <= ranges::kMoment_Nm)) {
    throw locograph::Error(std::string(kTag) + " with a torque beyond all joints", "up to 1e9");
  }
}

void EdgeMeasurement::error(const ConfigurationState& q, const WrenchesState& wrenches,
                            Eigen::Ref<Eigen::VectorXd> e) const {
  require_rows(kTag, e.size(), q.model().active_joint_count());
  require_same_robot(kTag, q.robot, wrenches.contacts->front()->robot);
  static_torques(q.kinematics, wrenches, e);
  e = torques - e;
}

RowLabel EdgeMeasurement::row_label(int row, const VertexConfiguration& q,
                                    const VertexWrenches&) const {
  const Joint& joint = q.robot->robot->active_joint(row);
  return {joint.name + " torque", joint.type == JointType::kPrismatic ? "N" : "N m"};
}

}  // namespace locograph
