#pragma once
/// Planar edges on several points seen from one pose at once, their errors correlated.
///
///     EdgeSE2LotsOfXY scan;
///     scan.resize(2 * 3);                                  // three points
///     scan.measurement << 1.0, 0.0, 0.0, 2.0, -1.0, 0.5;   // x y of each, in the pose
///     graph.add_dynamic_edge(scan, {a, b, c}, pose);

#include <locograph/core/typed_edge_pool.h>
#include <locograph/types/slam2d/vertices.h>

namespace locograph {

/// EDGE_SE2_TWOPOINTSXY: two points. Error (4) [m]: A⁻¹ p − z of each.
struct EdgeSE2TwoPointsXY : Edge<4, VertexSE2, VertexXY, VertexXY> {
  Eigen::Vector4d measurement = Eigen::Vector4d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE2<T>& a, const Eigen::Matrix<T, 2, 1>& p, const Eigen::Matrix<T, 2, 1>& q,
             Eigen::Ref<Eigen::Matrix<T, 4, 1>> e) const {
    e.template head<2>() = a.inverse_rotate(p - a.translation());
    e.template tail<2>() = a.inverse_rotate(q - a.translation());
    e -= measurement.template cast<T>();
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE2_TWOPOINTSXY", EdgeSE2TwoPointsXY)

/// EDGE_SE2_LOTSOFXY: any number n of points. In a file `TAG pose points… || n x y… Ω`. Error (2n)
/// [m]: A⁻¹ p − z of each.
struct EdgeSE2LotsOfXY : DynamicEdge<Eigen::Dynamic, VertexXY, VertexSE2> {
  static constexpr int kRowsPerVertex = 2;
  Eigen::VectorXd measurement;  ///< x y of each point, in the pose
  auto fields() { return std::tie(measurement); }
  void resize(int dimension) {
    measurement.setZero(dimension);
    information.setIdentity(dimension, dimension);
  }
  /// Throws Error unless there is a measurement of every point.
  void bind(const Parameters&) const;

  void error(const SE2<double>& a, std::span<const Eigen::Vector2d> points,
             Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const SE2<double>& a, std::span<const Eigen::Vector2d> points,
                 std::span<JacobianMap> j) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE2_LOTSOFXY", EdgeSE2LotsOfXY)

// Compiled once, with the registration.
extern template class TypedEdgePool<EdgeSE2TwoPointsXY>;
extern template class TypedEdgePool<EdgeSE2LotsOfXY>;

}  // namespace locograph
