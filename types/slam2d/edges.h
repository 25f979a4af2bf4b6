#pragma once
/// Planar edges: relative pose, point and bearing measurements, priors.
/// Tags, order of fields and errors are those of the `.g2o` format.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/types/slam2d/parameters.h>
#include <locograph/types/slam2d/vertices.h>

namespace locograph {

/// EDGE_SE2: relative pose. Error (3): translation and wrapped angle of Z⁻¹ (A⁻¹ B), as in
/// Grisetti et al. 2010 (A Tutorial on Graph-Based SLAM), eq. 30–32.
struct EdgeSE2 : Edge<3, VertexSE2, VertexSE2> {
  SE2<double> measurement;
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE2<T>& a, const SE2<T>& b, Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    const SE2<T> z = measurement.template cast<T>();
    const Eigen::Matrix<T, 2, 1> between = a.inverse_rotate(b.translation() - a.translation());
    e.template head<2>() = z.inverse_rotate(between - z.translation());
    e[2] = wrap_angle(T(b.angle() - a.angle() - z.angle()));
  }
  void jacobians(const SE2<double>& a, const SE2<double>& b, JacobianRef<EdgeSE2, 0> ja,
                 JacobianRef<EdgeSE2, 1> jb) const;
  SE2<double> predict_second(const SE2<double>& a) const { return a * measurement; }
  SE2<double> predict_first(const SE2<double>& b) const { return b * measurement.inverse(); }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE2", EdgeSE2)

/// EDGE_SE2_XY: a point seen from a pose. Error (2) [m]: A⁻¹ p − z.
struct EdgeSE2XY : Edge<2, VertexSE2, VertexXY> {
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE2<T>& a, const Eigen::Matrix<T, 2, 1>& p,
             Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    e = a.inverse_rotate(p - a.translation()) - measurement.template cast<T>();
  }
  void jacobians(const SE2<double>& a, const Eigen::Vector2d& p, JacobianRef<EdgeSE2XY, 0> ja,
                 JacobianRef<EdgeSE2XY, 1> jp) const;
  Eigen::Vector2d predict_second(const SE2<double>& a) const { return a * measurement; }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE2_XY", EdgeSE2XY)

/// EDGE_BEARING_SE2_XY: direction to a point. Error (1) [rad]: wrapped bearing − z.
struct EdgeBearingSE2XY : Edge<1, VertexSE2, VertexXY> {
  double measurement = 0.0;
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE2<T>& a, const Eigen::Matrix<T, 2, 1>& p,
             Eigen::Ref<Eigen::Matrix<T, 1, 1>> e) const {
    using std::atan2;
    const Eigen::Matrix<T, 2, 1> d = a.inverse_rotate(p - a.translation());
    e[0] = wrap_angle(T(atan2(d[1], d[0]) - T(measurement)));
  }
  void jacobians(const SE2<double>& a, const Eigen::Vector2d& p,
                 JacobianRef<EdgeBearingSE2XY, 0> ja, JacobianRef<EdgeBearingSE2XY, 1> jp) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_BEARING_SE2_XY", EdgeBearingSE2XY)

/// EDGE_PRIOR_SE2: absolute pose. Error (3): translation and wrapped angle of Z⁻¹ A.
struct EdgePriorSE2 : Edge<3, VertexSE2> {
  SE2<double> measurement;
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE2<T>& a, Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    const SE2<T> z = measurement.template cast<T>();
    e.template head<2>() = z.inverse_rotate(a.translation() - z.translation());
    e[2] = wrap_angle(T(a.angle() - z.angle()));
  }
  void jacobians(const SE2<double>& a, JacobianRef<EdgePriorSE2, 0> ja) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_PRIOR_SE2", EdgePriorSE2)

/// EDGE_PRIOR_SE2_XY: absolute position of a pose. Error (2) [m]: t − z.
struct EdgePriorSE2XY : Edge<2, VertexSE2> {
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE2<T>& a, Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    e = a.translation() - measurement.template cast<T>();
  }
  void jacobians(const SE2<double>&, JacobianRef<EdgePriorSE2XY, 0> ja) const {
    ja << 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_PRIOR_SE2_XY", EdgePriorSE2XY)

/// EDGE_PRIOR_XY: absolute position of a point. Error (2) [m]: p − z.
struct EdgePriorXY : Edge<2, VertexXY> {
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const Eigen::Matrix<T, 2, 1>& p, Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    e = p - measurement.template cast<T>();
  }
  void jacobians(const Eigen::Vector2d&, JacobianRef<EdgePriorXY, 0> jp) const { jp.setIdentity(); }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_PRIOR_XY", EdgePriorXY)

/// EDGE_POINTXY: relative position of two points. Error (2) [m]: (q − p) − z.
struct EdgePointXY : Edge<2, VertexXY, VertexXY> {
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const Eigen::Matrix<T, 2, 1>& p, const Eigen::Matrix<T, 2, 1>& q,
             Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    e = q - p - measurement.template cast<T>();
  }
  void jacobians(const Eigen::Vector2d&, const Eigen::Vector2d&, JacobianRef<EdgePointXY, 0> jp,
                 JacobianRef<EdgePointXY, 1> jq) const {
    jp = -Eigen::Matrix2d::Identity();
    jq.setIdentity();
  }
  Eigen::Vector2d predict_second(const Eigen::Vector2d& p) const { return p + measurement; }
  Eigen::Vector2d predict_first(const Eigen::Vector2d& q) const { return q - measurement; }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_POINTXY", EdgePointXY)

/// EDGE_SE2_OFFSET: relative pose of two sensors, each mounted on its pose. Fields: numbers of the
/// two PARAMS_SE2OFFSET, measurement. Error (3): as EDGE_SE2, of A·oₐ and B·o_b.
struct EdgeSE2Offset : Edge<3, VertexSE2, VertexSE2> {
  int first_offset = 0, second_offset = 0;
  SE2<double> measurement;
  SE2<double> first, second;  ///< the offsets, looked up by bind()
  auto fields() { return std::tie(first_offset, second_offset, measurement); }
  void bind(const Parameters& parameters) {
    first = parameters.get<OffsetSE2>(first_offset)->offset;
    second = parameters.get<OffsetSE2>(second_offset)->offset;
  }

  template <class T>
  void error(const SE2<T>& a, const SE2<T>& b, Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    EdgeSE2 between;
    between.measurement = measurement;
    between.error<T>(a * first.template cast<T>(), b * second.template cast<T>(), e);
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE2_OFFSET", EdgeSE2Offset)

/// EDGE_SE2_XY_OFFSET: a point seen by a sensor mounted on a pose. Fields: number of the
/// PARAMS_SE2OFFSET, measurement. Error (2) [m]: (A·o)⁻¹ p − z. Not a tag of g2o's own: see
/// EdgeSE2PointXYOffset.
struct EdgeSE2XYOffset : Edge<2, VertexSE2, VertexXY> {
  int offset_number = 0;
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  SE2<double> offset;
  auto fields() { return std::tie(offset_number, measurement); }
  void bind(const Parameters& parameters) {
    offset = parameters.get<OffsetSE2>(offset_number)->offset;
  }

  template <class T>
  void error(const SE2<T>& a, const Eigen::Matrix<T, 2, 1>& p,
             Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    const SE2<T> sensor = a * offset.template cast<T>();
    e = sensor.inverse_rotate(p - sensor.translation()) - measurement.template cast<T>();
  }
  Eigen::Vector2d predict_second(const SE2<double>& a) const { return a * offset * measurement; }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE2_XY_OFFSET", EdgeSE2XYOffset)

/// EDGE_SE2_POINTXY_OFFSET: the same fields, error (2) [m]: A⁻¹ p − z. The offset is named and kept
/// but does not enter: g2o computes and simulates this edge so, and its files mean it so.
struct EdgeSE2PointXYOffset : Edge<2, VertexSE2, VertexXY> {
  int offset_number = 0;
  EdgeSE2XY point;
  auto fields() { return std::tie(offset_number, point.measurement); }
  void bind(const Parameters& parameters) { parameters.get<OffsetSE2>(offset_number); }

  template <class T>
  void error(const SE2<T>& a, const Eigen::Matrix<T, 2, 1>& p,
             Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    point.error<T>(a, p, e);
  }
  void jacobians(const SE2<double>& a, const Eigen::Vector2d& p,
                 JacobianRef<EdgeSE2PointXYOffset, 0> ja,
                 JacobianRef<EdgeSE2PointXYOffset, 1> jp) const {
    point.jacobians(a, p, ja, jp);
  }
  Eigen::Vector2d predict_second(const SE2<double>& a) const { return point.predict_second(a); }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE2_POINTXY_OFFSET", EdgeSE2PointXYOffset)

// Compiled once, with the registration.
extern template class TypedVertexPool<VertexSE2>;
extern template class TypedVertexPool<VertexXY>;
extern template class TypedEdgePool<EdgeSE2>;
extern template class TypedEdgePool<EdgeSE2XY>;
extern template class TypedEdgePool<EdgeBearingSE2XY>;
extern template class TypedEdgePool<EdgePriorSE2>;
extern template class TypedEdgePool<EdgePriorSE2XY>;
extern template class TypedEdgePool<EdgePriorXY>;
extern template class TypedEdgePool<EdgePointXY>;
extern template class TypedEdgePool<EdgeSE2Offset>;
extern template class TypedEdgePool<EdgeSE2XYOffset>;
extern template class TypedEdgePool<EdgeSE2PointXYOffset>;

}  // namespace locograph
