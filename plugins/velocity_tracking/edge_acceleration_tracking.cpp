#include <locograph/common/skew.h>
#include <locograph/plugins/acceleration_limits/acceleration_rows.h>
#include <locograph/plugins/velocity_tracking/edge_acceleration_tracking.h>
#include <locograph/robots/orientation_error.h>

namespace locograph {

template class TypedEdgePool<EdgeAccelerationTracking>;

namespace {

SecondDifference difference(const ConfigurationState& a, const ConfigurationState& b,
                            const ConfigurationState& c) {
  return {b.time_s - a.time_s, c.time_s - b.time_s};
}

/// Of b and the ones before and after it, in the base frame of b.
Eigen::Vector3d linear_part(const SecondDifference& d, const ConfigurationState& a,
                            const ConfigurationState& b, const ConfigurationState& c) {
  return b.base_rotation().conjugate() * (d.step_2 * (c.base_position() - b.base_position()) +
                                          d.step_1 * (a.base_position() - b.base_position()));
}

}  // namespace

EdgeAccelerationTracking::EdgeAccelerationTracking(const Eigen::VectorXd& acceleration_,
                                                   const Eigen::VectorXd& weights_)
    : acceleration(acceleration_) {
  weights = weights_;
}

void EdgeAccelerationTracking::error(const ConfigurationState& a, const ConfigurationState& b,
                                     const ConfigurationState& c,
                                     Eigen::Ref<Eigen::VectorXd> e) const {
  require_same_robot(kTag, a.robot, b.robot);
  require_same_robot(kTag, c.robot, b.robot);
  require_rows(kTag, e.size(), b.model().tangent_size());
  const SecondDifference d = difference(a, b, c);
  d.require_increasing(kTag);
  const int base = b.model().base_tangent_size();
  if (base > 0) {
    e.head<3>() = linear_part(d, a, b, c);
    e.segment<3>(3) =
        d.step_2 * relative_base_rotation(b, c) + d.step_1 * relative_base_rotation(b, a);
  }
  for (int i = 0; i < b.model().active_joint_count(); ++i) {
    const double here = b.joint(i);
    e[base + i] = d.step_2 * (c.joint(i) - here) + d.step_1 * (a.joint(i) - here);
  }
  e -= acceleration;
}

void EdgeAccelerationTracking::jacobians(const ConfigurationState& a, const ConfigurationState& b,
                                         const ConfigurationState& c,
                                         JacobianRef<EdgeAccelerationTracking, 0> ja,
                                         JacobianRef<EdgeAccelerationTracking, 1> jb,
                                         JacobianRef<EdgeAccelerationTracking, 2> jc) const {
  const SecondDifference d = difference(a, b, c);
  const int base = b.model().base_tangent_size();
  if (base > 0) {
    const Eigen::Quaterniond back = b.base_rotation().conjugate();
    ja.topLeftCorner<3, 3>() = d.step_1 * (back * a.base_rotation()).toRotationMatrix();
    jc.topLeftCorner<3, 3>() = d.step_2 * (back * c.base_rotation()).toRotationMatrix();
    jb.topLeftCorner<3, 3>() = -(d.step_1 + d.step_2) * Eigen::Matrix3d::Identity();
    // Turning B by δ turns what is seen from it by −δ.
    jb.block<3, 3>(0, 3) = skew(linear_part(d, a, b, c));
    // log(exp(−δ) R) ≈ log R − J_l⁻¹ δ, and J_l⁻¹(v) = J_r⁻¹(−v).
    const Eigen::Vector3d to_a = relative_base_rotation(b, a), to_c = relative_base_rotation(b, c);
    ja.block<3, 3>(3, 3) = d.step_1 * inverse_right_jacobian(to_a);
    jc.block<3, 3>(3, 3) = d.step_2 * inverse_right_jacobian(to_c);
    jb.block<3, 3>(3, 3) =
        -d.step_1 * inverse_right_jacobian(-to_a) - d.step_2 * inverse_right_jacobian(-to_c);
  }
  for (int i = base; i < jb.rows(); ++i) {
    ja(i, i) = d.step_1;
    jb(i, i) = -(d.step_1 + d.step_2);
    jc(i, i) = d.step_2;
  }
}

}  // namespace locograph
