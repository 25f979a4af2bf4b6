#include <locograph/common/skew.h>
#include <locograph/types/slam3d/edges.h>
#include <locograph/types/slam3d/expmap.h>
#include <locograph/types/slam3d/planes_and_lines.h>
#include <locograph/types/slam3d/priors.h>
#include <locograph/types/slam3d/slam3d.h>

namespace locograph {
template class TypedVertexPool<VertexSE3>;
template class TypedVertexPool<VertexPointXYZ>;
template class TypedEdgePool<EdgeSE3>;
template class TypedEdgePool<EdgeSE3PointXYZ>;
template class TypedEdgePool<EdgeSE3Offset>;
template class TypedEdgePool<EdgeSE3LotsOfXYZ>;
template class TypedEdgePool<EdgeSE3Calib>;
template class TypedEdgePool<EdgePointXYZ>;
template class TypedEdgePool<EdgeProjectDepth>;
template class TypedEdgePool<EdgeProjectDisparity>;

void EdgeSE3::jacobians(const SE3<double>& a, const SE3<double>& b, JacobianRef<EdgeSE3, 0> ja,
                        JacobianRef<EdgeSE3, 1> jb) const {
  // With A ← A exp(d): A⁻¹B ← exp(−d) A⁻¹B, so its translation t changes by −d_t + t × d_r and its
  // quaternion by −½ (0, d_r) ⊗ q. With B ← B exp(d): by R d_t and ½ q ⊗ (0, d_r).
  const SE3<double> between = a.inverse() * b;
  const Eigen::Matrix3d z_transposed = measurement.rotation().conjugate().toRotationMatrix();
  const Eigen::Quaterniond e = measurement.rotation().conjugate() * between.rotation();
  const double half = e.w() < 0.0 ? -0.5 : 0.5;
  const Eigen::Matrix3d cross = skew(e.vec());
  const Eigen::Matrix3d w = e.w() * Eigen::Matrix3d::Identity();
  ja.topLeftCorner<3, 3>() = -z_transposed;
  ja.topRightCorner<3, 3>() = z_transposed * skew(between.translation());
  ja.bottomLeftCorner<3, 3>().setZero();
  ja.bottomRightCorner<3, 3>() = -half * (w - cross) * z_transposed;
  jb.topLeftCorner<3, 3>() = e.toRotationMatrix();
  jb.topRightCorner<3, 3>().setZero();
  jb.bottomLeftCorner<3, 3>().setZero();
  jb.bottomRightCorner<3, 3>() = half * (w + cross);
}

void EdgeSE3PointXYZ::jacobians(const SE3<double>& a, const Eigen::Vector3d& p,
                                JacobianRef<EdgeSE3PointXYZ, 0> ja,
                                JacobianRef<EdgeSE3PointXYZ, 1> jp) const {
  const Eigen::Vector3d in_a = a.rotation().conjugate() * (p - a.translation());
  const Eigen::Matrix3d sensor_from_a = offset.rotation().conjugate().toRotationMatrix();
  ja.leftCols<3>() = -sensor_from_a;
  ja.rightCols<3>() = sensor_from_a * skew(in_a);
  jp = sensor_from_a * a.rotation().conjugate().toRotationMatrix();
}

void EdgeSE3LotsOfXYZ::bind(const Parameters&) const {
  const std::size_t points = vertices.size() - 1;
  if (measurement.size() != kRowsPerVertex * static_cast<Eigen::Index>(points)) {
    throw locograph::Error("an edge on " + std::to_string(points) + " points measures " +
                               std::to_string(measurement.size()) + " coordinates",
                           std::to_string(kRowsPerVertex) + " of each point");
  }
}

void EdgeSE3LotsOfXYZ::error(const SE3<double>& a, std::span<const Eigen::Vector3d> points,
                             Eigen::Ref<Eigen::VectorXd> e) const {
  const Eigen::Quaterniond back = a.rotation().conjugate();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Index row = kRowsPerVertex * static_cast<Eigen::Index>(i);
    e.segment<3>(row) = back * (points[i] - a.translation()) - measurement.segment<3>(row);
  }
}

void EdgeSE3LotsOfXYZ::jacobians(const SE3<double>& a, std::span<const Eigen::Vector3d> points,
                                 std::span<JacobianMap> j) const {
  const Eigen::Matrix3d back = a.rotation().conjugate().toRotationMatrix();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Index row = kRowsPerVertex * static_cast<Eigen::Index>(i);
    j[0].block<3, 3>(row, 0) = -Eigen::Matrix3d::Identity();
    j[0].block<3, 3>(row, 3) = skew(back * (points[i] - a.translation()));
    j[1 + i].setZero();
    j[1 + i].middleRows<3>(row) = back;
  }
}

void add_slam3d_types(TypeRegistry& types) {
  types.add_parameter<OffsetSE3>("PARAMS_SE3OFFSET");
  types.add_parameter<CameraCalibration>("PARAMS_CAMERACALIB");
  types.add_parameter<StereoCameraCalibration>("PARAMS_STEREOCAMERACALIB");
  types.add_vertex<VertexSE3>();
  types.add_vertex<VertexPointXYZ>();
  types.add_vertex_alias<VertexPointXYZ>("VERTEX_POINT_XYZ");
  types.add_vertex_alias<VertexPointXYZ>("VERTEX_XYZ");
  types.add_edge<EdgeSE3>();
  types.add_edge<EdgeSE3PointXYZ>();
  types.add_edge<EdgeSE3LotsOfXYZ>();
  types.add_edge<EdgeSE3Offset>();
  types.add_edge<EdgeSE3Calib>();
  types.add_edge<EdgePointXYZ>();
  types.add_edge_alias<EdgePointXYZ>("EDGE_POINT_XYZ");
  types.add_edge<EdgeProjectDepth>();
  types.add_edge<EdgeProjectDisparity>();
  add_slam3d_prior_types(types);
  add_slam3d_plane_and_line_types(types);
  add_slam3d_expmap_types(types);
}

}  // namespace locograph
