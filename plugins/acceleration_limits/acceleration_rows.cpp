#include <locograph/plugins/acceleration_limits/acceleration_rows.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/robots/orientation_error.h>

#include <cmath>

namespace locograph {

SecondDifference::SecondDifference(double dt_1_s, double dt_2_s)
    : dt_1(dt_1_s),
      dt_2(dt_2_s),
      step_1(2.0 / (dt_1_s * (dt_1_s + dt_2_s))),
      step_2(2.0 / (dt_2_s * (dt_1_s + dt_2_s))) {}

SecondDifference SecondDifference::from_rest(double dt_s) {
  SecondDifference difference;
  difference.dt_2 = dt_s;
  difference.step_2 = 2.0 / (dt_s * dt_s);
  return difference;
}

void SecondDifference::require_increasing(std::string_view tag) const {
  if (dt_2 > 0.0 && (dt_1 > 0.0 || step_1 == 0.0)) return;
  throw Error(std::string(tag) + " between configurations " + std::to_string(dt_1) + " and " +
                  std::to_string(dt_2) + " s apart",
              "times that increase");
}

void AccelerationRows::check(std::string_view tag, const Eigen::VectorXd& limits, int rows,
                             const Parameters& parameters) {
  require_fitting_robot(parameters, tag, rows,
                        [](const RobotParameter& p) { return count(*p.robot); });
  require_rows("limits of " + std::string(tag), limits.size(), rows);
  for (const double limit : limits) {
    if (!(limit >= 0.0)) {
      throw Error("a limit of acceleration of " + std::to_string(limit), "0 (none) or more");
    }
  }
}

double AccelerationRows::joint(int i) const {
  const SecondDifference& d = m_.difference;
  const double here = m_.here.joint(i);
  return d.step_2 * (m_.after.joint(i) - here) - d.step_1 * (here - m_.before.joint(i));
}

Eigen::Vector3d AccelerationRows::linear() const {
  const SecondDifference& d = m_.difference;
  return d.step_2 * (m_.after.base_position() - m_.here.base_position()) -
         d.step_1 * (m_.here.base_position() - m_.before.base_position());
}

Eigen::Vector3d AccelerationRows::angular() const {
  const SecondDifference& d = m_.difference;
  return d.step_2 * relative_base_rotation(m_.here, m_.after) -
         d.step_1 * relative_base_rotation(m_.before, m_.here);
}

bool AccelerationRows::limited(int row) const {
  const Robot& robot = m_.here.model();
  return limits_[row] > 0.0 && (row < robot.active_joint_count() || robot.floating_base());
}

void AccelerationRows::error(LimitKind kind, Eigen::Ref<Eigen::VectorXd> e) const {
  const int n = m_.here.model().active_joint_count();
  require_same_robot(tag_, m_.before.robot, m_.here.robot);
  require_same_robot(tag_, m_.before.robot, m_.after.robot);
  require_rows(tag_, e.size(), n + 2);
  const SecondDifference& d = m_.difference;
  d.require_increasing(tag_);
  e.setZero();
  for (int i = 0; i < n; ++i) {
    if (limited(i)) e[i] = limit_error(kind, std::abs(joint(i)) - limits_[i]);
  }
  if (limited(n)) e[n] = limit_error(kind, linear().norm() - limits_[n]);
  if (limited(n + 1)) e[n + 1] = limit_error(kind, angular().norm() - limits_[n + 1]);
}

void AccelerationRows::by_configurations(LimitKind kind, Jacobian* before, Jacobian here,
                                         Jacobian after) const {
  const Robot& robot = m_.here.model();
  const SecondDifference& d = m_.difference;
  const int n = robot.active_joint_count(), base = robot.base_tangent_size();
  const double middle = -(d.step_1 + d.step_2);
  for (int i = 0; i < n; ++i) {
    if (!limited(i)) continue;
    const double acceleration = joint(i);
    if (!limit_acts(kind, std::abs(acceleration) - limits_[i])) continue;
    const double direction = sign(acceleration);
    if (before != nullptr) (*before)(i, base + i) = direction * d.step_1;
    here(i, base + i) = direction * middle;
    after(i, base + i) = direction * d.step_2;
  }
  if (limited(n)) {
    const Eigen::Vector3d acceleration = linear();
    if (limit_acts(kind, acceleration.norm() - limits_[n])) {
      const Eigen::RowVector3d direction = acceleration.normalized().transpose();
      const auto by_base = [&](const ConfigurationState& q, double weight) {
        return Eigen::RowVector3d(weight * direction * q.base_rotation().toRotationMatrix());
      };
      if (before != nullptr) before->row(n).head<3>() = by_base(m_.before, d.step_1);
      here.row(n).head<3>() = by_base(m_.here, middle);
      after.row(n).head<3>() = by_base(m_.after, d.step_2);
    }
  }
  if (limited(n + 1)) {
    const Eigen::Vector3d acceleration = angular();
    if (limit_acts(kind, acceleration.norm() - limits_[n + 1])) {
      const Eigen::Vector3d back = relative_base_rotation(m_.before, m_.here),
                            forth = relative_base_rotation(m_.here, m_.after);
      // log(AᵀB): turning B by δ adds J_r⁻¹ δ, turning A by δ takes J_l⁻¹ δ = J_r⁻¹(−log) δ away.
      const Eigen::RowVector3d direction = acceleration.normalized().transpose();
      if (before != nullptr) {
        before->row(n + 1).segment<3>(3) = d.step_1 * direction * inverse_right_jacobian(-back);
      }
      here.row(n + 1).segment<3>(3) = -direction * (d.step_1 * inverse_right_jacobian(back) +
                                                    d.step_2 * inverse_right_jacobian(-forth));
      after.row(n + 1).segment<3>(3) = d.step_2 * direction * inverse_right_jacobian(forth);
    }
  }
}

// With T = Δt₁ + Δt₂: Δt₁ ∂a/∂Δt₁ = w₁ Δ₁ − a Δt₁/T and Δt₂ ∂a/∂Δt₂ = −w₂ Δ₂ − a Δt₂/T.
void AccelerationRows::by_log_steps(LimitKind kind, Column* before, Column after) const {
  const int n = m_.here.model().active_joint_count();
  const SecondDifference& d = m_.difference;
  const double total = d.dt_1 + d.dt_2;
  // size: |a|; back, forth: the displacements along a's direction.
  const auto fill = [&](int row, double size, double back, double forth) {
    if (!limit_acts(kind, size - limits_[row])) return;
    if (before != nullptr) (*before)[row] = d.step_1 * back - size * d.dt_1 / total;
    after[row] = -d.step_2 * forth - size * d.dt_2 / total;
  };
  for (int i = 0; i < n; ++i) {
    if (!limited(i)) continue;
    const double acceleration = joint(i), direction = sign(acceleration), q = m_.here.joint(i);
    fill(i, std::abs(acceleration), direction * (q - m_.before.joint(i)),
         direction * (m_.after.joint(i) - q));
  }
  const auto fill_vector = [&](int row, const Eigen::Vector3d& acceleration,
                               const Eigen::Vector3d& back, const Eigen::Vector3d& forth) {
    const Eigen::Vector3d direction = acceleration.normalized();
    fill(row, acceleration.norm(), direction.dot(back), direction.dot(forth));
  };
  if (limited(n)) {
    const Eigen::Vector3d p = m_.here.base_position();
    fill_vector(n, linear(), p - m_.before.base_position(), m_.after.base_position() - p);
  }
  if (limited(n + 1)) {
    fill_vector(n + 1, angular(), relative_base_rotation(m_.before, m_.here),
                relative_base_rotation(m_.here, m_.after));
  }
}

}  // namespace locograph
