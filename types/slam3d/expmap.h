#pragma once
/// Camera poses as bundle adjustment with g2o writes them: VERTEX_SE3:EXPMAP, the relative pose of
/// two of them, and points projected into them.
///
///     VertexSE3Expmap looking(world_from_camera);    // z looks ahead, x right, y down
///     EdgeProjectXYZ2UV pixel;
///     pixel.camera_number = 0;                       // PARAMS_CAMERAPARAMETERS 0 500 320 240 0
///     pixel.measurement = {310.0, 250.0};
///     graph.add_edge(pixel, point, graph.add_vertex(3, looking));
///
/// Files hold world_from_camera. g2o inverts it when it reads and writes; here the state is what
/// the file holds, and errors are written accordingly.

#include <locograph/core/parameters.h>
#include <locograph/core/type_registry.h>
#include <locograph/core/typed_edge_pool.h>
#include <locograph/types/slam3d/vertices.h>

namespace locograph {

/// VERTEX_SE3:EXPMAP: world_from_camera. State, fields and tangent as VERTEX_SE3:QUAT.
struct VertexSE3Expmap : VertexSE3 {
  using VertexSE3::VertexSE3;
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_SE3:EXPMAP", VertexSE3Expmap)

/// PARAMS_CAMERAPARAMETERS: focal length, principal point u v [px], baseline of a stereo pair [m].
struct PinholeCamera final : Parameter {
  double focal_px = 1.0, u_px = 0.0, v_px = 0.0, baseline_m = 0.5;
  std::string_view tag() const override { return "PARAMS_CAMERAPARAMETERS"; }
  void read(FieldReader& in) override {
    read_fields(in, std::tie(focal_px, u_px, v_px, baseline_m));
  }
  void write(FieldWriter& out) const override {
    for (const double value : {focal_px, u_px, v_px, baseline_m}) out.number(value);
  }
};

/// Logarithm of a rigid motion: rotation vector, then the translation that exp() would integrate
/// (Solà et al. 2018, A micro Lie theory, eq. 173–174). Smooth around the identity.
template <class T>
Eigen::Matrix<T, 6, 1> se3_log(const SE3<T>& pose) {
  using std::atan2;
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T sign = pose.rotation().w() < T(0) ? T(-1) : T(1);
  const Eigen::Matrix<T, 3, 1> v = sign * pose.rotation().vec();
  const T w = sign * pose.rotation().w();
  const T squared = v.squaredNorm();
  T factor = T(2) / w * (T(1) - squared / (T(3) * w * w));
  T second = T(1.0 / 12.0) + squared / T(180);
  if (squared > T(1e-10)) {
    const T length = sqrt(squared);
    const T angle = T(2) * atan2(length, w);
    factor = angle / length;
    // 1 − (θ/2) cot(θ/2) over θ², the cotangent being w / |v|.
    second = (T(1) - angle * w / (T(2) * length)) / (angle * angle);
  }
  const Eigen::Matrix<T, 3, 1> omega = factor * v;
  const Eigen::Matrix<T, 3, 1>& t = pose.translation();
  Eigen::Matrix<T, 6, 1> log;
  log.template head<3>() = omega;
  const Eigen::Matrix<T, 3, 1> cross = omega.cross(t);
  log.template tail<3>() = t - T(0.5) * cross + second * omega.cross(cross);
  return log;
}

/// EDGE_SE3:EXPMAP: relative pose. Error (6): se3_log of B Z⁻¹ A⁻¹, rotation first.
struct EdgeSE3Expmap : Edge<6, VertexSE3Expmap, VertexSE3Expmap> {
  SE3<double> measurement;
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE3<T>& a, const SE3<T>& b, Eigen::Ref<Eigen::Matrix<T, 6, 1>> e) const {
    e = se3_log(b * measurement.template cast<T>().inverse() * a.inverse());
  }
  SE3<double> predict_second(const SE3<double>& a) const { return a * measurement; }
  SE3<double> predict_first(const SE3<double>& b) const { return b * measurement.inverse(); }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE3:EXPMAP", EdgeSE3Expmap)

/// EDGE_PROJECT_XYZ2UV:EXPMAP: a point in an image. Vertices: point, camera. Fields: number of the
/// PARAMS_CAMERAPARAMETERS, u v [px]. Error (2) [px]: z − predicted.
struct EdgeProjectXYZ2UV : Edge<2, VertexPointXYZ, VertexSE3Expmap> {
  int camera_number = 0;
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  std::shared_ptr<const PinholeCamera> camera;
  auto fields() { return std::tie(camera_number, measurement); }
  void bind(const Parameters& parameters) { camera = parameters.get<PinholeCamera>(camera_number); }

  void error(const Eigen::Vector3d& p, const SE3<double>& a, Eigen::Ref<Eigen::Vector2d> e) const;
  void jacobians(const Eigen::Vector3d& p, const SE3<double>& a,
                 JacobianRef<EdgeProjectXYZ2UV, 0> jp, JacobianRef<EdgeProjectXYZ2UV, 1> ja) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_PROJECT_XYZ2UV:EXPMAP", EdgeProjectXYZ2UV)

/// EDGE_PROJECT_XYZ2UVU:EXPMAP: the same by a stereo pair; the third number is u in the right
/// image.
struct EdgeProjectXYZ2UVU : Edge<3, VertexPointXYZ, VertexSE3Expmap> {
  int camera_number = 0;
  Eigen::Vector3d measurement = Eigen::Vector3d::Zero();
  std::shared_ptr<const PinholeCamera> camera;
  auto fields() { return std::tie(camera_number, measurement); }
  void bind(const Parameters& parameters) { camera = parameters.get<PinholeCamera>(camera_number); }

  void error(const Eigen::Vector3d& p, const SE3<double>& a, Eigen::Ref<Eigen::Vector3d> e) const;
  void jacobians(const Eigen::Vector3d& p, const SE3<double>& a,
                 JacobianRef<EdgeProjectXYZ2UVU, 0> jp,
                 JacobianRef<EdgeProjectXYZ2UVU, 1> ja) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_PROJECT_XYZ2UVU:EXPMAP", EdgeProjectXYZ2UVU)

// Compiled once, with the registration.
extern template class TypedVertexPool<VertexSE3Expmap>;
extern template class TypedEdgePool<EdgeSE3Expmap>;
extern template class TypedEdgePool<EdgeProjectXYZ2UV>;
extern template class TypedEdgePool<EdgeProjectXYZ2UVU>;

/// Everything above.
void add_slam3d_expmap_types(TypeRegistry& types);

}  // namespace locograph
