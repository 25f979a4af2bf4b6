#pragma once
/// Spatial edges: relative pose, point and camera measurements. Tags, order of fields and errors
/// are those of the `.g2o` format.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/types/slam3d/parameters.h>
#include <locograph/types/slam3d/vertices.h>

namespace locograph {

/// Translation, and vector part of the quaternion with w ≥ 0: the error of a pose E ≈ identity in
/// all edges here (the convention of `.g2o` files).
template <class T>
void pose_error(const SE3<T>& pose, Eigen::Ref<Eigen::Matrix<T, 6, 1>> e) {
  const T sign = pose.rotation().w() < T(0) ? T(-1) : T(1);
  e.template head<3>() = pose.translation();
  e.template tail<3>() = sign * pose.rotation().vec();
}

/// EDGE_SE3:QUAT: relative pose. Error (6): pose_error of Z⁻¹ (A⁻¹ B).
struct EdgeSE3 : Edge<6, VertexSE3, VertexSE3> {
  SE3<double> measurement;
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE3<T>& a, const SE3<T>& b, Eigen::Ref<Eigen::Matrix<T, 6, 1>> e) const {
    pose_error<T>(measurement.template cast<T>().inverse() * (a.inverse() * b), e);
  }
  void jacobians(const SE3<double>& a, const SE3<double>& b, JacobianRef<EdgeSE3, 0> ja,
                 JacobianRef<EdgeSE3, 1> jb) const;
  SE3<double> predict_second(const SE3<double>& a) const { return a * measurement; }
  SE3<double> predict_first(const SE3<double>& b) const { return b * measurement.inverse(); }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE3:QUAT", EdgeSE3)

/// EDGE_SE3_TRACKXYZ: a point seen by a sensor. Fields: number of the PARAMS_SE3OFFSET,
/// measurement. Error (3) [m]: (A·o)⁻¹ p − z.
struct EdgeSE3PointXYZ : Edge<3, VertexSE3, VertexPointXYZ> {
  int offset_number = 0;
  Eigen::Vector3d measurement = Eigen::Vector3d::Zero();
  SE3<double> offset;
  auto fields() { return std::tie(offset_number, measurement); }
  void bind(const Parameters& parameters) {
    offset = parameters.get<OffsetSE3>(offset_number)->offset;
  }

  template <class T>
  void error(const SE3<T>& a, const Eigen::Matrix<T, 3, 1>& p,
             Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    const SE3<T> sensor = a * offset.template cast<T>();
    e = sensor.rotation().conjugate() * (p - sensor.translation()) - measurement.template cast<T>();
  }
  void jacobians(const SE3<double>& a, const Eigen::Vector3d& p, JacobianRef<EdgeSE3PointXYZ, 0> ja,
                 JacobianRef<EdgeSE3PointXYZ, 1> jp) const;
  Eigen::Vector3d predict_second(const SE3<double>& a) const { return a * offset * measurement; }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE3_TRACKXYZ", EdgeSE3PointXYZ)

/// EDGE_SE3_OFFSET: relative pose of two sensors. Fields: numbers of the two PARAMS_SE3OFFSET,
/// measurement. Error (6): pose_error of Z⁻¹ ((A·oₐ)⁻¹ (B·o_b)).
struct EdgeSE3Offset : Edge<6, VertexSE3, VertexSE3> {
  int first_offset = 0, second_offset = 0;
  SE3<double> measurement;
  SE3<double> first, second;
  auto fields() { return std::tie(first_offset, second_offset, measurement); }
  void bind(const Parameters& parameters) {
    first = parameters.get<OffsetSE3>(first_offset)->offset;
    second = parameters.get<OffsetSE3>(second_offset)->offset;
  }

  template <class T>
  void error(const SE3<T>& a, const SE3<T>& b, Eigen::Ref<Eigen::Matrix<T, 6, 1>> e) const {
    const SE3<T> sensor_a = a * first.template cast<T>(), sensor_b = b * second.template cast<T>();
    pose_error<T>(measurement.template cast<T>().inverse() * (sensor_a.inverse() * sensor_b), e);
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE3_OFFSET", EdgeSE3Offset)

/// EDGE_SE3_LOTSOF_XYZ: any number n of points seen from a pose, their errors correlated. In a file
/// `TAG pose points… || n x y z… Ω`. Error (3n) [m]: A⁻¹ p − z of each.
struct EdgeSE3LotsOfXYZ : DynamicEdge<Eigen::Dynamic, VertexPointXYZ, VertexSE3> {
  static constexpr int kRowsPerVertex = 3;
  Eigen::VectorXd measurement;  ///< x y z of each point, in the pose
  auto fields() { return std::tie(measurement); }
  void resize(int dimension) {
    measurement.setZero(dimension);
    information.setIdentity(dimension, dimension);
  }
  /// Throws Error unless there is a measurement of every point.
  void bind(const Parameters&) const;

  void error(const SE3<double>& a, std::span<const Eigen::Vector3d> points,
             Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const SE3<double>& a, std::span<const Eigen::Vector3d> points,
                 std::span<JacobianMap> j) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE3_LOTSOF_XYZ", EdgeSE3LotsOfXYZ)

/// EDGE_SE3_CALIB: relative pose of a sensor whose mount C is estimated, a vertex shared by all
/// edges of that sensor. Error (6): pose_error of Z⁻¹ ((A·C)⁻¹ (B·C)).
struct EdgeSE3Calib : Edge<6, VertexSE3, VertexSE3, VertexSE3> {
  SE3<double> measurement;
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE3<T>& a, const SE3<T>& b, const SE3<T>& mount,
             Eigen::Ref<Eigen::Matrix<T, 6, 1>> e) const {
    pose_error<T>(measurement.template cast<T>().inverse() * ((a * mount).inverse() * (b * mount)),
                  e);
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE3_CALIB", EdgeSE3Calib)

/// EDGE_POINTXYZ, also read as EDGE_POINT_XYZ: relative position of two points. Error (3) [m]: (q −
/// p) − z.
struct EdgePointXYZ : Edge<3, VertexPointXYZ, VertexPointXYZ> {
  Eigen::Vector3d measurement = Eigen::Vector3d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const Eigen::Matrix<T, 3, 1>& p, const Eigen::Matrix<T, 3, 1>& q,
             Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    e = q - p - measurement.template cast<T>();
  }
  void jacobians(const Eigen::Vector3d&, const Eigen::Vector3d&, JacobianRef<EdgePointXYZ, 0> jp,
                 JacobianRef<EdgePointXYZ, 1> jq) const {
    jp = -Eigen::Matrix3d::Identity();
    jq.setIdentity();
  }
  Eigen::Vector3d predict_second(const Eigen::Vector3d& p) const { return p + measurement; }
  Eigen::Vector3d predict_first(const Eigen::Vector3d& q) const { return q - measurement; }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_POINTXYZ", EdgePointXYZ)

/// EDGE_PROJECT_DEPTH: a point in a depth camera. Fields: number of the PARAMS_CAMERACALIB,
/// measurement (u, v [px], depth [m]). Error (3): predicted − measured.
struct EdgeProjectDepth : Edge<3, VertexSE3, VertexPointXYZ> {
  int camera_number = 0;
  Eigen::Vector3d measurement = Eigen::Vector3d::Zero();
  std::shared_ptr<const CameraCalibration> camera;
  auto fields() { return std::tie(camera_number, measurement); }
  void bind(const Parameters& parameters) {
    camera = parameters.get<CameraCalibration>(camera_number);
  }

  template <class T>
  void error(const SE3<T>& a, const Eigen::Matrix<T, 3, 1>& p,
             Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    project(a, p, e);
    e -= measurement.template cast<T>();
  }
  template <class T>
  void project(const SE3<T>& a, const Eigen::Matrix<T, 3, 1>& p,
               Eigen::Ref<Eigen::Matrix<T, 3, 1>> image) const {
    const SE3<T> sensor = a * camera->offset.template cast<T>();
    const Eigen::Matrix<T, 3, 1> c = sensor.rotation().conjugate() * (p - sensor.translation());
    image[0] = T(camera->fx) * c[0] / c[2] + T(camera->cx);
    image[1] = T(camera->fy) * c[1] / c[2] + T(camera->cy);
    image[2] = c[2];
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_PROJECT_DEPTH", EdgeProjectDepth)

/// EDGE_PROJECT_DISPARITY: the same with the inverse depth [1/m] as third coordinate.
struct EdgeProjectDisparity : Edge<3, VertexSE3, VertexPointXYZ> {
  EdgeProjectDepth depth;
  auto fields() { return depth.fields(); }
  void bind(const Parameters& parameters) { depth.bind(parameters); }

  template <class T>
  void error(const SE3<T>& a, const Eigen::Matrix<T, 3, 1>& p,
             Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    depth.project(a, p, e);
    e[2] = T(1) / e[2];
    e -= depth.measurement.template cast<T>();
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_PROJECT_DISPARITY", EdgeProjectDisparity)

// Compiled once, with the registration.
extern template class TypedVertexPool<VertexSE3>;
extern template class TypedVertexPool<VertexPointXYZ>;
extern template class TypedEdgePool<EdgeSE3>;
extern template class TypedEdgePool<EdgeSE3PointXYZ>;
extern template class TypedEdgePool<EdgeSE3Offset>;
extern template class TypedEdgePool<EdgeSE3LotsOfXYZ>;
extern template class TypedEdgePool<EdgeSE3Calib>;
extern template class TypedEdgePool<EdgePointXYZ>;
extern template class TypedEdgePool<EdgeProjectDepth>;
extern template class TypedEdgePool<EdgeProjectDisparity>;

}  // namespace locograph
