#include <locograph/plugins/acceleration_limits/edge_acceleration_limits.h>
#include <locograph/plugins/configuration/orientation_error.h>

#include <cmath>

namespace locograph {

template class TypedEdgePool<EdgeAccelerationLimits>;

namespace {

/// Weights of three samples in their second derivative.
struct SecondDifference {
  double first, second, third;
  double step_1, step_2;  ///< weights of the two displacements: −first and third

  SecondDifference(const ConfigurationState& a, const ConfigurationState& b,
                   const ConfigurationState& c) {
    const double dt_1 = b.time_s - a.time_s, dt_2 = c.time_s - b.time_s;
    if (!(dt_1 > 0.0 && dt_2 > 0.0)) {
      throw Error(std::string(EdgeAccelerationLimits::kTag) + " between configurations at " +
                      std::to_string(a.time_s) + ", " + std::to_string(b.time_s) + " and " +
                      std::to_string(c.time_s) + " s",
                  "times that increase");
    }
    step_1 = 2.0 / (dt_1 * (dt_1 + dt_2));
    step_2 = 2.0 / (dt_2 * (dt_1 + dt_2));
    first = step_1;
    second = -(step_1 + step_2);
    third = step_2;
  }
};

Eigen::Vector3d linear_acceleration(const ConfigurationState& a, const ConfigurationState& b,
                                    const ConfigurationState& c, const SecondDifference& d) {
  return d.step_2 * (c.base_position() - b.base_position()) -
         d.step_1 * (b.base_position() - a.base_position());
}

double joint_acceleration(const ConfigurationState& a, const ConfigurationState& b,
                          const ConfigurationState& c, const SecondDifference& d, int i) {
  return d.step_2 * (c.joint(i) - b.joint(i)) - d.step_1 * (b.joint(i) - a.joint(i));
}

}  // namespace

EdgeAccelerationLimits::EdgeAccelerationLimits(const Eigen::VectorXd& limits_, double weight)
    : limits(limits_) {
  weights.setConstant(limits.size(), weight);
}

EdgeAccelerationLimits::EdgeAccelerationLimits(const Robot& robot, double joint, double base_linear,
                                               double base_angular, double weight) {
  resize(robot.active_joint_count() + 2);
  limits.setConstant(joint);
  limits.tail<2>() << base_linear, base_angular;
  weights.setConstant(weight);
}

void EdgeAccelerationLimits::bind(const Parameters& parameters) const {
  require_fitting_robot(parameters, kTag, dimension(),
                        [](const RobotParameter& p) { return p.robot->active_joint_count() + 2; });
  require_rows("limits of EDGE_ACCELERATION_LIMITS", limits.size(), dimension());
  for (const double limit : limits) {
    if (!(limit >= 0.0)) {
      throw locograph::Error("a limit of acceleration of " + std::to_string(limit),
                             "0 (none) or more");
    }
  }
}

void EdgeAccelerationLimits::error(const ConfigurationState& a, const ConfigurationState& b,
                                   const ConfigurationState& c,
                                   Eigen::Ref<Eigen::VectorXd> e) const {
  const Robot& robot = a.model();
  const int n = robot.active_joint_count();
  require_same_robot(kTag, a.robot, b.robot);
  require_same_robot(kTag, a.robot, c.robot);
  require_rows(kTag, e.size(), n + 2);
  const SecondDifference d(a, b, c);
  e.setZero();
  for (int i = 0; i < n; ++i) {
    if (limits[i] == 0.0) continue;
    e[i] = std::max(0.0, std::abs(joint_acceleration(a, b, c, d, i)) - limits[i]);
  }
  if (!robot.floating_base()) return;
  if (limits[n] > 0.0) {
    e[n] = std::max(0.0, linear_acceleration(a, b, c, d).norm() - limits[n]);
  }
  if (limits[n + 1] > 0.0) {
    const Eigen::Vector3d angular =
        d.step_2 * relative_base_rotation(b, c) - d.step_1 * relative_base_rotation(a, b);
    e[n + 1] = std::max(0.0, angular.norm() - limits[n + 1]);
  }
}

void EdgeAccelerationLimits::jacobians(const ConfigurationState& a, const ConfigurationState& b,
                                       const ConfigurationState& c,
                                       JacobianRef<EdgeAccelerationLimits, 0> ja,
                                       JacobianRef<EdgeAccelerationLimits, 1> jb,
                                       JacobianRef<EdgeAccelerationLimits, 2> jc) const {
  const Robot& robot = a.model();
  const int n = robot.active_joint_count(), base = robot.base_tangent_size();
  const SecondDifference d(a, b, c);
  for (int i = 0; i < n; ++i) {
    if (limits[i] == 0.0) continue;
    const double acceleration = joint_acceleration(a, b, c, d, i);
    if (std::abs(acceleration) <= limits[i]) continue;
    const double sign = acceleration > 0.0 ? 1.0 : -1.0;
    ja(i, base + i) = sign * d.first;
    jb(i, base + i) = sign * d.second;
    jc(i, base + i) = sign * d.third;
  }
  if (!robot.floating_base()) return;
  if (limits[n] > 0.0) {
    const Eigen::Vector3d acceleration = linear_acceleration(a, b, c, d);
    if (acceleration.norm() > limits[n]) {
      const Eigen::RowVector3d direction = acceleration.normalized().transpose();
      ja.row(n).head<3>() = d.first * direction * a.base_rotation().toRotationMatrix();
      jb.row(n).head<3>() = d.second * direction * b.base_rotation().toRotationMatrix();
      jc.row(n).head<3>() = d.third * direction * c.base_rotation().toRotationMatrix();
    }
  }
  if (limits[n + 1] > 0.0) {
    const Eigen::Vector3d before = relative_base_rotation(a, b),
                          after = relative_base_rotation(b, c);
    const Eigen::Vector3d acceleration = d.step_2 * after - d.step_1 * before;
    if (acceleration.norm() > limits[n + 1]) {
      // log(AᵀB): turning B by δ adds J_r⁻¹ δ, turning A by δ takes J_l⁻¹ δ = J_r⁻¹(−log) δ away.
      const Eigen::RowVector3d direction = acceleration.normalized().transpose();
      ja.row(n + 1).segment<3>(3) = d.step_1 * direction * inverse_right_jacobian(-before);
      jb.row(n + 1).segment<3>(3) = -direction * (d.step_1 * inverse_right_jacobian(before) +
                                                  d.step_2 * inverse_right_jacobian(-after));
      jc.row(n + 1).segment<3>(3) = d.step_2 * direction * inverse_right_jacobian(after);
    }
  }
}

}  // namespace locograph
