#include <locograph/plugins/velocity_limits/edge_velocity_limits.h>

#include <cmath>

namespace locograph {

template class TypedEdgePool<EdgeVelocityLimits>;

EdgeVelocityLimits::EdgeVelocityLimits(const Robot& robot, double fraction_, double base_linear,
                                       double base_angular, double weight)
    : fraction(fraction_), base_linear_m_s(base_linear), base_angular_rad_s(base_angular) {
  weights.setConstant(robot.active_joint_count() + 2, weight);
}

void EdgeVelocityLimits::error(const ConfigurationState& a, const ConfigurationState& b,
                               Eigen::Ref<Eigen::VectorXd> e) const {
  const Robot& robot = a.model();
  const double dt = b.time_s - a.time_s;
  const int n = robot.active_joint_count();
  require_same_robot(kTag, a.robot, b.robot);
  require_rows(kTag, e.size(), n + 2);
  for (int i = 0; i < n; ++i) {
    const double most = fraction * robot.active_joint(i).max_velocity * dt;
    e[i] = std::max(0.0, std::abs(b.joint(i) - a.joint(i)) - most);
  }
  e.tail<2>().setZero();
  if (!robot.floating_base()) return;
  if (base_linear_m_s > 0.0) {
    e[n] = std::max(0.0, (b.base_position() - a.base_position()).norm() - base_linear_m_s * dt);
  }
  if (base_angular_rad_s > 0.0) {
    e[n + 1] = std::max(0.0, relative_base_rotation(a, b).norm() - base_angular_rad_s * dt);
  }
}

void EdgeVelocityLimits::jacobians(const ConfigurationState& a, const ConfigurationState& b,
                                   JacobianRef<EdgeVelocityLimits, 0> ja,
                                   JacobianRef<EdgeVelocityLimits, 1> jb) const {
  const Robot& robot = a.model();
  const double dt = b.time_s - a.time_s;
  const int n = robot.active_joint_count(), base = robot.base_tangent_size();
  for (int i = 0; i < n; ++i) {
    const double moved = b.joint(i) - a.joint(i);
    if (std::abs(moved) <= fraction * robot.active_joint(i).max_velocity * dt) continue;
    jb(i, base + i) = moved > 0.0 ? 1.0 : -1.0;
    ja(i, base + i) = -jb(i, base + i);
  }
  if (!robot.floating_base()) return;
  if (base_linear_m_s > 0.0) {
    const Eigen::Vector3d moved = b.base_position() - a.base_position();
    if (moved.norm() > base_linear_m_s * dt) {
      const Eigen::Vector3d direction = moved.normalized();
      ja.row(n).head<3>() = -direction.transpose() * a.base_rotation().toRotationMatrix();
      jb.row(n).head<3>() = direction.transpose() * b.base_rotation().toRotationMatrix();
    }
  }
  if (base_angular_rad_s > 0.0) {
    // d|log(AᵀB)| = axis · (δb − δa): the axis has the same coordinates in both base frames.
    const Eigen::Vector3d turned = relative_base_rotation(a, b);
    if (turned.norm() > base_angular_rad_s * dt) {
      ja.row(n + 1).segment<3>(3) = -turned.normalized().transpose();
      jb.row(n + 1).segment<3>(3) = turned.normalized().transpose();
    }
  }
}

}  // namespace locograph
