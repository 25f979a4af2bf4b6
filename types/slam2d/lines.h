#pragma once
/// Lines and segments in the plane, and edges that see them.
///
/// A line is (θ, ρ): the points p with n·p = ρ, n = (cos θ, sin θ). A segment is its two end
/// points. Seen from a pose with heading φ at t, a line has the angle θ − φ and the distance ρ −
/// n·t.

#include <locograph/core/type_registry.h>
#include <locograph/core/typed_edge_pool.h>
#include <locograph/types/slam2d/vertices.h>

namespace locograph {

/// VERTEX_LINE2D: θ [rad], ρ [m], and the ids of two points that end it for drawing (-1: none).
/// Tangent (2): added.
struct VertexLine2D : Vertex<2, 2> {
  int first_end = -1, second_end = -1;  ///< not part of the state

  template <class T>
  using View = Eigen::Matrix<T, 2, 1>;
  template <class T>
  static View<T> view(const T* s) {
    return View<T>(s[0], s[1]);
  }
  template <class T>
  static void oplus(const T* s, const T* d, T* out) {
    out[0] = wrap_angle(T(s[0] + d[0]));
    out[1] = s[1] + d[1];
  }
  static void store(const Eigen::Vector2d& line, double* s) {
    s[0] = line[0];
    s[1] = line[1];
  }
  void read(FieldReader& in) { read_fields(in, std::tie(state, first_end, second_end)); }
  void write(FieldWriter& out) const {
    write_field(out, state);
    out.integer(first_end);
    out.integer(second_end);
  }
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_LINE2D", VertexLine2D)

/// VERTEX_SEGMENT2D: x y of both ends [m]. Tangent (4): added.
struct VertexSegment2D : Vertex<4, 4> {
  template <class T>
  using View = Eigen::Matrix<T, 4, 1>;
  template <class T>
  static View<T> view(const T* s) {
    return View<T>(s[0], s[1], s[2], s[3]);
  }
  template <class T>
  static void oplus(const T* s, const T* d, T* out) {
    for (int i = 0; i < 4; ++i) out[i] = s[i] + d[i];
  }
  static void store(const Eigen::Vector4d& ends, double* s) {
    for (int i = 0; i < 4; ++i) s[i] = ends[i];
  }
  void read(FieldReader& in) {
    read_field(in, state);
    if (state.head<2>() == state.tail<2>()) in.fail("a segment of length zero", "two ends apart");
  }
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_SEGMENT2D", VertexSegment2D)

/// EDGE_SE2_LINE2D: a line seen from a pose. Error (2): wrapped θ and ρ in the pose, minus z.
struct EdgeSE2Line2D : Edge<2, VertexSE2, VertexLine2D> {
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE2<T>& a, const Eigen::Matrix<T, 2, 1>& line,
             Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    using std::cos;
    using std::sin;
    const Eigen::Matrix<T, 2, 1> normal(cos(line[0]), sin(line[0]));
    e[0] = wrap_angle(T(line[0] - a.angle() - T(measurement[0])));
    e[1] = line[1] - normal.dot(a.translation()) - T(measurement[1]);
  }
  Eigen::Vector2d predict_second(const SE2<double>& a) const {
    const double angle = wrap_angle(measurement[0] + a.angle());
    const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
    return {angle, measurement[1] + normal.dot(a.translation())};
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE2_LINE2D", EdgeSE2Line2D)

/// EDGE_LINE2D: difference of two lines. Error (2): (l − k) − z, the angle wrapped (g2o leaves that
/// out, and so has a jump where a line's own angle wraps).
struct EdgeLine2D : Edge<2, VertexLine2D, VertexLine2D> {
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const Eigen::Matrix<T, 2, 1>& k, const Eigen::Matrix<T, 2, 1>& l,
             Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    e = l - k - measurement.template cast<T>();
    e[0] = wrap_angle(T(e[0]));
  }
  void jacobians(const Eigen::Vector2d&, const Eigen::Vector2d&, JacobianRef<EdgeLine2D, 0> jk,
                 JacobianRef<EdgeLine2D, 1> jl) const {
    jk = -Eigen::Matrix2d::Identity();
    jl.setIdentity();
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_LINE2D", EdgeLine2D)

/// EDGE_LINE2D_POINTXY: distance of a point from a line. Error (1) [m]: n·p − ρ − z.
struct EdgeLine2DPointXY : Edge<1, VertexLine2D, VertexXY> {
  double measurement = 0.0;
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const Eigen::Matrix<T, 2, 1>& line, const Eigen::Matrix<T, 2, 1>& p,
             Eigen::Ref<Eigen::Matrix<T, 1, 1>> e) const {
    using std::cos;
    using std::sin;
    e[0] = cos(line[0]) * p[0] + sin(line[0]) * p[1] - line[1] - T(measurement);
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_LINE2D_POINTXY", EdgeLine2DPointXY)

/// The ends of a segment in a pose, and the direction of its normal there: that of the segment
/// turned a quarter to the right.
template <class T>
struct SegmentInPose {
  Eigen::Matrix<T, 2, 1> first, second, normal;
  SegmentInPose(const SE2<T>& a, const Eigen::Matrix<T, 4, 1>& ends)
      : first(a.inverse_rotate(ends.template head<2>() - a.translation())),
        second(a.inverse_rotate(ends.template tail<2>() - a.translation())),
        normal(second[1] - first[1], first[0] - second[0]) {}
  T angle() const {
    using std::atan2;
    return atan2(normal[1], normal[0]);
  }
};

/// EDGE_SE2_SEGMENT2D: both ends of a segment seen. Error (4) [m]: ends in the pose, minus z.
struct EdgeSE2Segment2D : Edge<4, VertexSE2, VertexSegment2D> {
  Eigen::Vector4d measurement = Eigen::Vector4d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE2<T>& a, const Eigen::Matrix<T, 4, 1>& ends,
             Eigen::Ref<Eigen::Matrix<T, 4, 1>> e) const {
    const SegmentInPose<T> seen(a, ends);
    e << seen.first, seen.second;
    e -= measurement.template cast<T>();
  }
  Eigen::Vector4d predict_second(const SE2<double>& a) const {
    Eigen::Vector4d ends;
    ends << a * Eigen::Vector2d(measurement.head<2>()), a * Eigen::Vector2d(measurement.tail<2>());
    return ends;
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE2_SEGMENT2D", EdgeSE2Segment2D)

/// EDGE_SE2_SEGMENT2D_LINE: the line through a segment seen, its ends not. Error (2): wrapped angle
/// of the normal, and distance along it, in the pose, minus z.
struct EdgeSE2Segment2DLine : Edge<2, VertexSE2, VertexSegment2D> {
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE2<T>& a, const Eigen::Matrix<T, 4, 1>& ends,
             Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    const SegmentInPose<T> seen(a, ends);
    e[0] = wrap_angle(T(seen.angle() - T(measurement[0])));
    e[1] = (seen.first + seen.second).dot(seen.normal) / (T(2) * seen.normal.norm()) -
           T(measurement[1]);
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE2_SEGMENT2D_LINE", EdgeSE2Segment2DLine)

/// EDGE_SE2_SEGMENT2D_POINTLINE: one end of a segment and its line seen. Fields: which end (0 or
/// 1), x y of it, angle of the normal. Error (3): these in the pose, minus z, the angle wrapped.
struct EdgeSE2Segment2DPointLine : Edge<3, VertexSE2, VertexSegment2D> {
  int end = 0;
  Eigen::Vector3d measurement = Eigen::Vector3d::Zero();
  auto fields() { return std::tie(end, measurement); }

  template <class T>
  void error(const SE2<T>& a, const Eigen::Matrix<T, 4, 1>& ends,
             Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    const SegmentInPose<T> seen(a, ends);
    e.template head<2>() =
        (end == 0 ? seen.first : seen.second) - measurement.head<2>().template cast<T>();
    e[2] = wrap_angle(T(seen.angle() - T(measurement[2])));
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE2_SEGMENT2D_POINTLINE", EdgeSE2Segment2DPointLine)

// Compiled once, with the registration.
extern template class TypedVertexPool<VertexLine2D>;
extern template class TypedVertexPool<VertexSegment2D>;
extern template class TypedEdgePool<EdgeSE2Line2D>;
extern template class TypedEdgePool<EdgeLine2D>;
extern template class TypedEdgePool<EdgeLine2DPointXY>;
extern template class TypedEdgePool<EdgeSE2Segment2D>;
extern template class TypedEdgePool<EdgeSE2Segment2DLine>;
extern template class TypedEdgePool<EdgeSE2Segment2DPointLine>;

/// Everything above.
void add_slam2d_line_types(TypeRegistry& types);

}  // namespace locograph
