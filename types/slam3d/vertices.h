#pragma once
/// Spatial vertices: VERTEX_SE3:QUAT (x y z qx qy qz qw) and VERTEX_TRACKXYZ, also written
/// VERTEX_POINT_XYZ or VERTEX_XYZ (x y z), in metres.

#include <locograph/core/vertex.h>
#include <locograph/types/slam3d/se3.h>

namespace locograph {

/// Pose. Tangent (6) in the pose's own frame: translation, rotation vector; X ⊞ d = X · exp(d).
struct VertexSE3 : Vertex<6, 7> {
  template <class T>
  using View = SE3<T>;
  template <class T>
  static SE3<T> view(const T* s) {
    return SE3<T>(s);
  }
  template <class T>
  static void oplus(const T* s, const T* d, T* out) {
    using Vector = Eigen::Matrix<T, 3, 1>;
    const SE3<T> pose(s);
    const Vector translation = pose * Vector(d[0], d[1], d[2]);
    Eigen::Quaternion<T> rotation = pose.rotation() * quaternion_exp(Vector(d[3], d[4], d[5]));
    rotation.normalize();
    SE3<T>(translation, rotation).store(out);
  }
  static void ominus(const double* a, const double* b, double* d) {
    const SE3<double> between = SE3<double>(b).inverse() * SE3<double>(a);
    Eigen::Map<Eigen::Matrix<double, 6, 1>>(d) << between.translation(),
        quaternion_log(between.rotation());
  }
  static void store(const SE3<double>& pose, double* s) { pose.store(s); }

  VertexSE3() { SE3<double>().store(state.data()); }
  explicit VertexSE3(const SE3<double>& pose) { pose.store(state.data()); }
  SE3<double> pose() const { return SE3<double>(state.data()); }

  void read(FieldReader& in) {
    SE3<double> pose;
    pose.read(in);
    pose.store(state.data());
  }
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_SE3:QUAT", VertexSE3)

/// Point in space.
struct VertexPointXYZ : Vertex<3, 3> {
  static constexpr bool kFlat = true;
  template <class T>
  using View = Eigen::Matrix<T, 3, 1>;
  template <class T>
  static View<T> view(const T* s) {
    return View<T>(s[0], s[1], s[2]);
  }
  template <class T>
  static void oplus(const T* s, const T* d, T* out) {
    for (int i = 0; i < 3; ++i) out[i] = s[i] + d[i];
  }
  static void ominus(const double* a, const double* b, double* d) {
    for (int i = 0; i < 3; ++i) d[i] = a[i] - b[i];
  }
  static void store(const Eigen::Vector3d& point, double* s) {
    for (int i = 0; i < 3; ++i) s[i] = point[i];
  }
  VertexPointXYZ() = default;
  explicit VertexPointXYZ(const Eigen::Vector3d& point) { state = point; }
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_TRACKXYZ", VertexPointXYZ)

}  // namespace locograph
