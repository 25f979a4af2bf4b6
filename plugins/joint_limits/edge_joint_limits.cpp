#include <locograph/plugins/joint_limits/edge_joint_limits.h>

namespace locograph {

template class TypedEdgePool<EdgeJointLimits>;

EdgeJointLimits::EdgeJointLimits(const Robot& robot, double margin_, double weight)
    : margin(margin_) {
  weights.setConstant(robot.active_joint_count(), weight);
}

void EdgeJointLimits::error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const {
  require_rows(kTag, e.size(), q.model().active_joint_count());
  for (int i = 0; i < e.size(); ++i) {
    const Joint& joint = q.model().active_joint(i);
    const double position = q.joint(i);
    e[i] = std::max({0.0, joint.lower + margin - position, position - joint.upper + margin});
  }
}

void EdgeJointLimits::jacobians(const ConfigurationState& q,
                                JacobianRef<EdgeJointLimits, 0> j) const {
  const int base = q.model().base_tangent_size();
  for (int i = 0; i < j.rows(); ++i) {
    const Joint& joint = q.model().active_joint(i);
    const double position = q.joint(i);
    const double below = joint.lower + margin - position, above = position - joint.upper + margin;
    if (std::max(below, above) > 0.0) j(i, base + i) = above > below ? 1.0 : -1.0;
  }
}

RowLabel EdgeJointLimits::row_label(int row, const VertexConfiguration& q) const {
  const Robot& robot = *q.robot->robot;
  const Joint& joint = robot.active_joint(row);
  const double position = q.state[robot.base_configuration_size() + row];
  const bool upper = position - joint.upper > joint.lower - position;
  return joint_row(robot, row, upper ? "upper limit" : "lower limit");
}

}  // namespace locograph
