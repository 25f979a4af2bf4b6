#pragma once
/// Planar vertices: VERTEX_SE2 (x y θ) and VERTEX_XY (x y), in metres and radians.

#include <locograph/core/vertex.h>
#include <locograph/types/slam2d/se2.h>

namespace locograph {

/// Planar pose. Tangent: (dx, dy) in world axes, dθ; both are added.
struct VertexSE2 : Vertex<3, 3> {
  static constexpr bool kFlat = true;
  template <class T>
  using View = SE2<T>;
  template <class T>
  static SE2<T> view(const T* s) {
    return SE2<T>(s[0], s[1], s[2]);
  }
  template <class T>
  static void oplus(const T* s, const T* d, T* out) {
    out[0] = s[0] + d[0];
    out[1] = s[1] + d[1];
    out[2] = wrap_angle(T(s[2] + d[2]));
  }
  static void ominus(const double* a, const double* b, double* d) {
    d[0] = a[0] - b[0];
    d[1] = a[1] - b[1];
    d[2] = wrap_angle(a[2] - b[2]);
  }
  static void store(const SE2<double>& pose, double* s) {
    s[0] = pose.translation()[0];
    s[1] = pose.translation()[1];
    s[2] = pose.angle();
  }
  VertexSE2() = default;
  explicit VertexSE2(const SE2<double>& pose) { store(pose, state.data()); }
  SE2<double> pose() const { return view(state.data()); }
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_SE2", VertexSE2)

/// Point in the plane.
struct VertexXY : Vertex<2, 2> {
  static constexpr bool kFlat = true;
  template <class T>
  using View = Eigen::Matrix<T, 2, 1>;
  template <class T>
  static View<T> view(const T* s) {
    return View<T>(s[0], s[1]);
  }
  template <class T>
  static void oplus(const T* s, const T* d, T* out) {
    out[0] = s[0] + d[0];
    out[1] = s[1] + d[1];
  }
  static void ominus(const double* a, const double* b, double* d) {
    d[0] = a[0] - b[0];
    d[1] = a[1] - b[1];
  }
  static void store(const Eigen::Vector2d& point, double* s) {
    s[0] = point[0];
    s[1] = point[1];
  }
  VertexXY() = default;
  explicit VertexXY(const Eigen::Vector2d& point) { state = point; }
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_XY", VertexXY)

}  // namespace locograph
