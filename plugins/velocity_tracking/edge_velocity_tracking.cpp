#include <locograph/plugins/velocity_tracking/edge_velocity_tracking.h>
#include <locograph/robots/orientation_error.h>

namespace locograph {

template class TypedEdgePool<EdgeVelocityTracking>;

EdgeVelocityTracking::EdgeVelocityTracking(const Eigen::VectorXd& step_,
                                           const Eigen::VectorXd& weights_)
    : step(step_) {
  weights = weights_;
}

void EdgeVelocityTracking::error(const ConfigurationState& a, const ConfigurationState& b,
                                 Eigen::Ref<Eigen::VectorXd> e) const {
  require_same_robot(kTag, a.robot, b.robot);
  require_rows(kTag, e.size(), a.model().tangent_size());
  a.model().difference(a.q.data(), b.q.data(), e.data());
  e -= step;
}

void EdgeVelocityTracking::jacobians(const ConfigurationState& a, const ConfigurationState& b,
                                     JacobianRef<EdgeVelocityTracking, 0> ja,
                                     JacobianRef<EdgeVelocityTracking, 1> jb) const {
  const int base = a.model().base_tangent_size();
  if (base > 0) {
    const Eigen::Quaterniond back = a.base_rotation().conjugate();
    const Eigen::Quaterniond relative = back * b.base_rotation();
    const Eigen::AngleAxisd rotation(relative);
    const Eigen::Vector3d log = rotation.angle() * rotation.axis();
    // Aᵀ (b − a): moving a by δ takes δ away; turning A by δ turns it by −δ: −δ × d = d × δ.
    const Eigen::Vector3d d = back * (b.base_position() - a.base_position());
    ja.topLeftCorner<3, 3>() = -Eigen::Matrix3d::Identity();
    ja.block<3, 3>(0, 3) << 0.0, -d[2], d[1], d[2], 0.0, -d[0], -d[1], d[0], 0.0;
    jb.topLeftCorner<3, 3>() = relative.toRotationMatrix();
    // log(exp(−δ) R) ≈ log R − J_l⁻¹ δ, and J_l⁻¹(v) = J_r⁻¹(−v).
    ja.block<3, 3>(3, 3) = -inverse_right_jacobian(-log);
    jb.block<3, 3>(3, 3) = inverse_right_jacobian(log);
  }
  for (int i = base; i < ja.rows(); ++i) {
    ja(i, i) = -1.0;
    jb(i, i) = 1.0;
  }
}

}  // namespace locograph
