#include <locograph/common/skew.h>
#include <locograph/types/bundle/camera_bal.h>

#include <cmath>

namespace locograph {
template class TypedVertexPool<VertexCameraBAL>;
template class TypedEdgePool<EdgeProjectBAL>;

void VertexCameraBAL::derive(const double* state, Derived& derived) const {
  const Eigen::Vector3d w(state[0], state[1], state[2]);
  const double squared = w.squaredNorm(), angle = std::sqrt(squared);
  // R = I + a [ω]× + b [ω]×² and left = I + b [ω]× + c [ω]×² (Chirikjian 2012, equation 10.86);
  // their series near zero.
  const bool small = squared < 1e-8;
  const double a = small ? 1.0 - squared / 6.0 : std::sin(angle) / angle;
  const double half = std::sin(0.5 * angle);
  const double b = small ? 0.5 - squared / 24.0 : 2.0 * half * half / squared;
  const double c = squared < 1e-4 ? 1.0 / 6.0 - squared / 120.0 : (1.0 - a) / squared;
  const Eigen::Matrix3d cross = skew(w);
  const Eigen::Matrix3d square = w * w.transpose() - squared * Eigen::Matrix3d::Identity();
  derived.rotation = Eigen::Matrix3d::Identity() + a * cross + b * square;
  derived.left = Eigen::Matrix3d::Identity() + b * cross + c * square;
  derived.translation << state[3], state[4], state[5];
  derived.focal = state[6];
  derived.k1 = state[7];
  derived.k2 = state[8];
}

void EdgeProjectBAL::jacobians(const VertexCameraBAL::Derived& camera, const Eigen::Vector3d& point,
                               JacobianRef<EdgeProjectBAL, 0> j_camera,
                               JacobianRef<EdgeProjectBAL, 1> j_point) const {
  const Eigen::Vector3d turned = camera.rotation * point;
  const Eigen::Vector3d seen = turned + camera.translation;
  const double inverse = -1.0 / seen[2];
  const Eigen::Vector2d p = inverse * seen.head<2>();
  const double r2 = p.squaredNorm();
  const double distortion = 1.0 + r2 * (camera.k1 + r2 * camera.k2);
  // ∂(d p)/∂p = d I + 2 d' p pᵀ, and ∂p/∂P = −1/P_z [I | p].
  const double slope = 2.0 * (camera.k1 + 2.0 * r2 * camera.k2);
  const double factor = camera.focal * inverse;
  Eigen::Matrix<double, 2, 3> by_seen;
  by_seen(0, 0) = factor * (distortion + slope * p[0] * p[0]);
  by_seen(0, 1) = by_seen(1, 0) = factor * slope * p[0] * p[1];
  by_seen(1, 1) = factor * (distortion + slope * p[1] * p[1]);
  by_seen.col(2) = p[0] * by_seen.col(0) + p[1] * by_seen.col(1);

  // −by_seen [R X]×: each row of it is (R X) × row.
  Eigen::Matrix<double, 2, 3> by_turn;
  for (int i = 0; i < 2; ++i) {
    by_turn(i, 0) = turned[1] * by_seen(i, 2) - turned[2] * by_seen(i, 1);
    by_turn(i, 1) = turned[2] * by_seen(i, 0) - turned[0] * by_seen(i, 2);
    by_turn(i, 2) = turned[0] * by_seen(i, 1) - turned[1] * by_seen(i, 0);
  }
  j_camera.leftCols<3>().noalias() = by_turn.lazyProduct(camera.left);
  j_camera.middleCols<3>(3) = by_seen;
  j_camera.col(6) = distortion * p;
  j_camera.col(7) = camera.focal * r2 * p;
  j_camera.col(8) = r2 * j_camera.col(7);
  j_point.noalias() = by_seen.lazyProduct(camera.rotation);
}

}  // namespace locograph
