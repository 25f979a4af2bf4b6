#pragma once
/// VERTEX_CAM: a camera that carries its own, constant calibration, as in `.g2o` files of sparse
/// bundle adjustment, and its measurements.
///
///     VERTEX_CAM 0  0 0 0 0 0 0 1  700 700 320 240 0.1
///     VERTEX_XYZ 1  0.5 0.2 4
///     EDGE_PROJECT_P2MC 1 0  407.5 275  1 0 1

#include <locograph/core/typed_edge_pool.h>
#include <locograph/types/slam3d/vertices.h>

namespace locograph {

/// What edges see of a VERTEX_CAM. The camera looks along its positive z axis.
template <class T>
struct CameraView {
  SE3<T> world_from_camera;
  T fx, fy, cx, cy;  ///< [px]
  T baseline_m;      ///< from this camera to the right one of a stereo pair
};

/// Pose x y z qx qy qz qw, then fx fy cx cy baseline. Tangent (6): that of VERTEX_SE3, the
/// calibration stays.
struct VertexCam : Vertex<6, 12> {
  template <class T>
  using View = CameraView<T>;
  template <class T>
  static CameraView<T> view(const T* s) {
    return {SE3<T>(s), s[7], s[8], s[9], s[10], s[11]};
  }
  template <class T>
  static void oplus(const T* s, const T* d, T* out) {
    VertexSE3::oplus(s, d, out);
    for (int i = 7; i < 12; ++i) out[i] = s[i];
  }
  VertexCam() {
    state.setZero();
    SE3<double>().store(state.data());
    state[7] = state[8] = 1.0;
  }
  explicit VertexCam(const CameraView<double>& camera) {
    camera.world_from_camera.store(state.data());
    state.tail<5>() << camera.fx, camera.fy, camera.cx, camera.cy, camera.baseline_m;
  }
  void read(FieldReader& in);
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_CAM", VertexCam)

/// EDGE_PROJECT_P2MC: a point in the image (u v) of a VERTEX_CAM. Error (2) [px]: predicted −
/// measured.
struct EdgeProjectP2MC : Edge<2, VertexPointXYZ, VertexCam> {
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const Eigen::Matrix<T, 3, 1>& point, const CameraView<T>& camera,
             Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    const SE3<T>& pose = camera.world_from_camera;
    const Eigen::Matrix<T, 3, 1> c = pose.rotation().conjugate() * (point - pose.translation());
    e[0] = camera.fx * c[0] / c[2] + camera.cx - T(measurement[0]);
    e[1] = camera.fy * c[1] / c[2] + camera.cy - T(measurement[1]);
  }
  void jacobians(const Eigen::Vector3d& point, const CameraView<double>& camera,
                 JacobianRef<EdgeProjectP2MC, 0> jp, JacobianRef<EdgeProjectP2MC, 1> jc) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_PROJECT_P2MC", EdgeProjectP2MC)

/// EDGE_PROJECT_P2SC: the same in a stereo pair (u v u_right). Error (3) [px].
struct EdgeProjectP2SC : Edge<3, VertexPointXYZ, VertexCam> {
  Eigen::Vector3d measurement = Eigen::Vector3d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const Eigen::Matrix<T, 3, 1>& point, const CameraView<T>& camera,
             Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    const SE3<T>& pose = camera.world_from_camera;
    const Eigen::Matrix<T, 3, 1> c = pose.rotation().conjugate() * (point - pose.translation());
    e[0] = camera.fx * c[0] / c[2] + camera.cx - T(measurement[0]);
    e[1] = camera.fy * c[1] / c[2] + camera.cy - T(measurement[1]);
    e[2] = camera.fx * (c[0] - camera.baseline_m) / c[2] + camera.cx - T(measurement[2]);
  }
  void jacobians(const Eigen::Vector3d& point, const CameraView<double>& camera,
                 JacobianRef<EdgeProjectP2SC, 0> jp, JacobianRef<EdgeProjectP2SC, 1> jc) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_PROJECT_P2SC", EdgeProjectP2SC)

// Compiled once, with the registration.
extern template class TypedVertexPool<VertexCam>;
extern template class TypedEdgePool<EdgeProjectP2MC>;
extern template class TypedEdgePool<EdgeProjectP2SC>;

}  // namespace locograph
