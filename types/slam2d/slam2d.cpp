#include <locograph/types/slam2d/calibration.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/slam2d/lines.h>
#include <locograph/types/slam2d/point_sets.h>
#include <locograph/types/slam2d/slam2d.h>

namespace locograph {
template class TypedVertexPool<VertexSE2>;
template class TypedVertexPool<VertexXY>;
template class TypedEdgePool<EdgeSE2>;
template class TypedEdgePool<EdgeSE2XY>;
template class TypedEdgePool<EdgeBearingSE2XY>;
template class TypedEdgePool<EdgePriorSE2>;
template class TypedEdgePool<EdgePriorSE2XY>;
template class TypedEdgePool<EdgePriorXY>;
template class TypedEdgePool<EdgePointXY>;
template class TypedEdgePool<EdgeSE2Offset>;
template class TypedEdgePool<EdgeSE2XYOffset>;
template class TypedEdgePool<EdgeSE2PointXYOffset>;
template class TypedEdgePool<EdgeSE2TwoPointsXY>;
template class TypedEdgePool<EdgeSE2LotsOfXY>;

namespace {

/// The inverse rotation of a pose, and the derivatives of A⁻¹ p: by the position −Rᵀ, by the
/// heading a quarter turn back of A⁻¹ p, by the point Rᵀ.
Eigen::Matrix2d rotation_transposed(const SE2<double>& a) {
  const double c = std::cos(a.angle()), s = std::sin(a.angle());
  Eigen::Matrix2d m;
  m << c, s, -s, c;
  return m;
}
Eigen::Matrix<double, 2, 3> seen_point_by_pose(const Eigen::Matrix2d& back,
                                               const Eigen::Vector2d& from_a) {
  const Eigen::Vector2d seen = back * from_a;
  Eigen::Matrix<double, 2, 3> m;
  m << -back, Eigen::Vector2d(seen[1], -seen[0]);
  return m;
}

}  // namespace

void EdgeSE2::jacobians(const SE2<double>& a, const SE2<double>& b, JacobianRef<EdgeSE2, 0> ja,
                        JacobianRef<EdgeSE2, 1> jb) const {
  // e_xy = R(−θz) (R(−θa) (b − a) − z); the derivative of R(−θa) is a quarter turn back.
  const double angle = a.angle() + measurement.angle();
  const double c = std::cos(angle), s = std::sin(angle);
  const Eigen::Vector2d d = b.translation() - a.translation();
  jb << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
  ja << -c, -s, c * d[1] - s * d[0], s, -c, -s * d[1] - c * d[0], 0.0, 0.0, -1.0;
}

void EdgeSE2XY::jacobians(const SE2<double>& a, const Eigen::Vector2d& p,
                          JacobianRef<EdgeSE2XY, 0> ja, JacobianRef<EdgeSE2XY, 1> jp) const {
  const Eigen::Matrix2d back = rotation_transposed(a);
  ja = seen_point_by_pose(back, p - a.translation());
  jp = back;
}

void EdgeBearingSE2XY::jacobians(const SE2<double>& a, const Eigen::Vector2d& p,
                                 JacobianRef<EdgeBearingSE2XY, 0> ja,
                                 JacobianRef<EdgeBearingSE2XY, 1> jp) const {
  // The bearing in the world, less the heading: atan2 changes by (−y, x) / r².
  const Eigen::Vector2d d = p - a.translation();
  jp << -d[1] / d.squaredNorm(), d[0] / d.squaredNorm();
  ja << -jp(0), -jp(1), -1.0;
}

void EdgePriorSE2::jacobians(const SE2<double>&, JacobianRef<EdgePriorSE2, 0> ja) const {
  ja.setIdentity();
  ja.topLeftCorner<2, 2>() = rotation_transposed(measurement);
}

void EdgeSE2LotsOfXY::bind(const Parameters&) const {
  const std::size_t points = vertices.size() - 1;
  if (measurement.size() != kRowsPerVertex * static_cast<Eigen::Index>(points)) {
    throw locograph::Error("an edge on " + std::to_string(points) + " points measures " +
                               std::to_string(measurement.size()) + " coordinates",
                           std::to_string(kRowsPerVertex) + " of each point");
  }
}

void EdgeSE2LotsOfXY::error(const SE2<double>& a, std::span<const Eigen::Vector2d> points,
                            Eigen::Ref<Eigen::VectorXd> e) const {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Index row = kRowsPerVertex * static_cast<Eigen::Index>(i);
    e.segment<2>(row) = a.inverse_rotate(points[i] - a.translation()) - measurement.segment<2>(row);
  }
}

void EdgeSE2LotsOfXY::jacobians(const SE2<double>& a, std::span<const Eigen::Vector2d> points,
                                std::span<JacobianMap> j) const {
  const Eigen::Matrix2d back = rotation_transposed(a);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Index row = kRowsPerVertex * static_cast<Eigen::Index>(i);
    j[0].middleRows<2>(row) = seen_point_by_pose(back, points[i] - a.translation());
    j[1 + i].setZero();
    j[1 + i].middleRows<2>(row) = back;
  }
}

void add_slam2d_types(TypeRegistry& types) {
  types.add_parameter<OffsetSE2>("PARAMS_SE2OFFSET");
  types.add_vertex<VertexSE2>();
  types.add_vertex<VertexXY>();
  types.add_edge<EdgeSE2>();
  types.add_edge<EdgeSE2XY>();
  types.add_edge<EdgeBearingSE2XY>();
  types.add_edge<EdgePriorSE2>();
  types.add_edge<EdgePriorSE2XY>();
  types.add_edge<EdgePriorXY>();
  types.add_edge<EdgePointXY>();
  types.add_edge<EdgeSE2Offset>();
  types.add_edge<EdgeSE2XYOffset>();
  types.add_edge<EdgeSE2PointXYOffset>();
  types.add_edge<EdgeSE2TwoPointsXY>();
  types.add_edge<EdgeSE2LotsOfXY>();
  add_slam2d_calibration_types(types);
  add_slam2d_line_types(types);
}

}  // namespace locograph
