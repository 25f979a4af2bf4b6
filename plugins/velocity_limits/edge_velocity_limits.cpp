#include <locograph/plugins/velocity_limits/edge_velocity_limits.h>
#include <locograph/plugins/velocity_limits/velocity_rows.h>

namespace locograph {

template class TypedEdgePool<EdgeVelocityLimits>;

EdgeVelocityLimits::EdgeVelocityLimits(const Robot& robot, double fraction_, double base_linear,
                                       double base_angular, double weight)
    : fraction(fraction_), base_linear_m_s(base_linear), base_angular_rad_s(base_angular) {
  weights.setConstant(robot.active_joint_count() + 2, weight);
}

void EdgeVelocityLimits::error(const ConfigurationState& a, const ConfigurationState& b,
                               Eigen::Ref<Eigen::VectorXd> e) const {
  VelocityRows{fraction, base_linear_m_s, base_angular_rad_s}.error(kTag, LimitKind::kHinged, a, b,
                                                                    b.time_s - a.time_s, e);
}

double EdgeVelocityLimits::row_tolerance(int row, const VertexConfiguration& a,
                                         const VertexConfiguration& b) const {
  return VelocityRows{fraction, base_linear_m_s, base_angular_rad_s}.tolerance(*a.robot->robot, row,
                                                                               b.time_s - a.time_s);
}

void EdgeVelocityLimits::jacobians(const ConfigurationState& a, const ConfigurationState& b,
                                   JacobianRef<EdgeVelocityLimits, 0> ja,
                                   JacobianRef<EdgeVelocityLimits, 1> jb) const {
  VelocityRows{fraction, base_linear_m_s, base_angular_rad_s}.jacobians(
      LimitKind::kHinged, a, b, b.time_s - a.time_s, ja, jb);
}

}  // namespace locograph
