#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/velocity_limits/velocity_rows.h>

#include <algorithm>
#include <cmath>

namespace locograph {

double VelocityRows::tolerance(const Robot& robot, int row, double dt_s) const {
  constexpr double kMost = 1e-3;  // rad, m
  if (row >= robot.active_joint_count() || !std::isfinite(joint_rate(robot, row))) return kMost;
  const double left = (1.0 - fraction) * robot.active_joint(row).max_velocity * dt_s;
  return std::min(kMost, margin_tolerance(left));
}

void VelocityRows::error(std::string_view tag, LimitKind kind, const ConfigurationState& a,
                         const ConfigurationState& b, double dt_s,
                         Eigen::Ref<Eigen::VectorXd> e) const {
  const Robot& robot = a.model();
  const int n = robot.active_joint_count();
  require_same_robot(tag, a.robot, b.robot);
  require_rows(tag, e.size(), count(robot));
  for (int i = 0; i < n; ++i) {
    const double rate = joint_rate(robot, i);
    e[i] = std::isfinite(rate) ? limit_error(kind, std::abs(b.joint(i) - a.joint(i)) - rate * dt_s)
                               : 0.0;
  }
  e.tail<2>().setZero();
  if (!robot.floating_base()) return;
  if (base_linear_m_s > 0.0) {
    const double moved = (b.base_position() - a.base_position()).norm();
    e[n] = limit_error(kind, moved - base_linear_m_s * dt_s);
  }
  if (base_angular_rad_s > 0.0) {
    const double turned = relative_base_rotation(a, b).norm();
    e[n + 1] = limit_error(kind, turned - base_angular_rad_s * dt_s);
  }
}

void VelocityRows::jacobians(LimitKind kind, const ConfigurationState& a,
                             const ConfigurationState& b, double dt_s, Jacobian ja, Jacobian jb,
                             Eigen::Ref<Eigen::VectorXd>* by_dt) const {
  const Robot& robot = a.model();
  const int n = robot.active_joint_count(), base = robot.base_tangent_size();
  const auto acts = [&](int row, double moved, double rate) {
    if (!limit_acts(kind, moved - rate * dt_s)) return false;
    if (by_dt != nullptr) (*by_dt)[row] = -rate;
    return true;
  };
  for (int i = 0; i < n; ++i) {
    const double moved = b.joint(i) - a.joint(i), rate = joint_rate(robot, i);
    if (!std::isfinite(rate) || !acts(i, std::abs(moved), rate)) continue;
    jb(i, base + i) = sign(moved);
    ja(i, base + i) = -jb(i, base + i);
  }
  if (!robot.floating_base()) return;
  if (base_linear_m_s > 0.0) {
    const Eigen::Vector3d moved = b.base_position() - a.base_position();
    if (acts(n, moved.norm(), base_linear_m_s)) {
      const Eigen::Vector3d direction = moved.normalized();
      ja.row(n).head<3>() = -direction.transpose() * a.base_rotation().toRotationMatrix();
      jb.row(n).head<3>() = direction.transpose() * b.base_rotation().toRotationMatrix();
    }
  }
  if (base_angular_rad_s > 0.0) {
    // d|log(AᵀB)| = axis · (δb − δa): the axis has the same coordinates in both base frames.
    const Eigen::Vector3d turned = relative_base_rotation(a, b);
    if (acts(n + 1, turned.norm(), base_angular_rad_s)) {
      ja.row(n + 1).segment<3>(3) = -turned.normalized().transpose();
      jb.row(n + 1).segment<3>(3) = turned.normalized().transpose();
    }
  }
}

}  // namespace locograph
