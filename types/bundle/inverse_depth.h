#pragma once
/// Points anchored in the camera that saw them first, known by the inverse of their depth there
/// (Civera, Davison & Montiel 2008): well-behaved for points that are far, or infinitely far, away.
///
///     PARAMS_CAMERACALIB 0  0 0 0 0 0 0 1  700 700 320 240
///     VERTEX_INVERSE_DEPTH 7  0.125 0.05 0.25
///     EDGE_PROJECT_INVERSE_DEPTH 0 1 7  0  390 275  1 0 1

#include <locograph/core/typed_edge_pool.h>
#include <locograph/types/slam3d/parameters.h>
#include <locograph/types/slam3d/vertices.h>

#include <memory>

namespace locograph {

/// The point at (x, y, 1) / ρ in the frame of its anchor.
template <class T>
struct InverseDepth {
  T x, y;  ///< normalised image coordinates in the anchor, constant
  T rho;   ///< inverse depth [1/m]
};

/// VERTEX_INVERSE_DEPTH: x y ρ. Tangent (1): ρ.
struct VertexInverseDepth : Vertex<1, 3> {
  template <class T>
  using View = InverseDepth<T>;
  template <class T>
  static InverseDepth<T> view(const T* s) {
    return {s[0], s[1], s[2]};
  }
  template <class T>
  static void oplus(const T* s, const T* d, T* out) {
    out[0] = s[0];
    out[1] = s[1];
    out[2] = s[2] + d[0];
  }
  VertexInverseDepth() = default;
  VertexInverseDepth(double x, double y, double rho) { state << x, y, rho; }
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_INVERSE_DEPTH", VertexInverseDepth)

/// EDGE_PROJECT_INVERSE_DEPTH: a point anchored at the first pose, seen from the second. Fields:
/// number of the PARAMS_CAMERACALIB both images share, u v. Error (2) [px]: predicted − measured.
struct EdgeProjectInverseDepth : Edge<2, VertexSE3, VertexSE3, VertexInverseDepth> {
  int camera_number = 0;
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  std::shared_ptr<const CameraCalibration> camera;
  auto fields() { return std::tie(camera_number, measurement); }
  void bind(const Parameters& parameters) {
    camera = parameters.get<CameraCalibration>(camera_number);
  }

  template <class T>
  void error(const SE3<T>& anchor, const SE3<T>& observer, const InverseDepth<T>& point,
             Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const SE3<T> offset = camera->offset.template cast<T>();
    const SE3<T> from_anchor = (observer * offset).inverse() * (anchor * offset);
    // ρ times the point in the observer's frame: no division where it is infinitely far.
    const Vector c = from_anchor.rotation() * Vector(point.x, point.y, T(1)) +
                     point.rho * from_anchor.translation();
    e[0] = T(camera->fx) * c[0] / c[2] + T(camera->cx) - T(measurement[0]);
    e[1] = T(camera->fy) * c[1] / c[2] + T(camera->cy) - T(measurement[1]);
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_PROJECT_INVERSE_DEPTH", EdgeProjectInverseDepth)

// Compiled once, with the registration.
extern template class TypedVertexPool<VertexInverseDepth>;
extern template class TypedEdgePool<EdgeProjectInverseDepth>;

}  // namespace locograph
