#pragma once
/// Cameras of "Bundle Adjustment in the Large" (Agarwal et al. 2010): every camera has its own
/// rotation, position, focal length and two radial distortions.
///
///     Graph graph = read_bal("problem.txt");      // types/bundle/bal_file.h
///
/// A point X [world] is seen at f·(1 + k₁r² + k₂r⁴)·p [px], with P = R X + t, p = −(P_x, P_y) / P_z
/// and r = |p|: the camera looks along its negative z axis.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/types/slam3d/vertices.h>

namespace locograph {

/// VERTEX_CAMERA_BAL: rotation vector of camera_from_world (3) [rad], t (3), f [px], k₁, k₂. The
/// tangent is added to these nine numbers.
struct VertexCameraBAL : Vertex<9, 9> {
  /// What all observations of a camera share.
  struct Derived {
    Eigen::Matrix3d rotation;  ///< R = exp(ω)
    Eigen::Matrix3d left;      ///< ∂(R X)/∂ω = −[R X]× · left
    Eigen::Vector3d translation;
    double focal, k1, k2;
  };
  Derived make_derived() const { return {}; }
  void derive(const double* state, Derived& derived) const;

  static void oplus(const double* s, const double* d, double* out) {
    for (int i = 0; i < 9; ++i) out[i] = s[i] + d[i];
  }
  VertexCameraBAL() = default;
  explicit VertexCameraBAL(const State& camera) { state = camera; }
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_CAMERA_BAL", VertexCameraBAL)

/// EDGE_PROJECT_BAL: a point in an image. Error (2) [px]: predicted − measured.
struct EdgeProjectBAL : Edge<2, VertexCameraBAL, VertexPointXYZ> {
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  auto fields() { return std::tie(measurement); }

  void error(const VertexCameraBAL::Derived& camera, const Eigen::Vector3d& point,
             Eigen::Ref<Eigen::Vector2d> e) const {
    const Eigen::Vector3d seen = camera.rotation * point + camera.translation;
    const Eigen::Vector2d p = -seen.head<2>() / seen[2];
    const double r2 = p.squaredNorm();
    e = camera.focal * (1.0 + r2 * (camera.k1 + r2 * camera.k2)) * p - measurement;
  }
  void jacobians(const VertexCameraBAL::Derived& camera, const Eigen::Vector3d& point,
                 JacobianRef<EdgeProjectBAL, 0> j_camera,
                 JacobianRef<EdgeProjectBAL, 1> j_point) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_PROJECT_BAL", EdgeProjectBAL)

// Compiled once, with the registration.
extern template class TypedVertexPool<VertexCameraBAL>;
extern template class TypedEdgePool<EdgeProjectBAL>;

}  // namespace locograph
