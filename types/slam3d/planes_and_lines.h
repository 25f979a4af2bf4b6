#pragma once
/// Planes and lines in space, and edges that see them from a pose.
///
///     EdgeSE3Plane wall;
///     wall.measurement.coefficients << 1, 0, 0, -2;   // x = 2 in the pose
///     graph.add_edge(wall, pose, plane);
///
/// A plane is (n, c), n a unit vector: the points p with n·p + c = 0; its distance from the origin
/// along n is −c. A line is in Plücker coordinates (w, d): d a unit vector along it, w = p × d for
/// its points p. Tangents and errors are those of g2o, which fix no more than their first order
/// around zero; here both are smooth also where the normal is vertical.

#include <locograph/core/type_registry.h>
#include <locograph/core/typed_edge_pool.h>
#include <locograph/types/slam3d/vertices.h>

namespace locograph {

/// Two unit vectors that complete a normal n to a right-handed basis (n, y, z): y horizontal, in
/// the direction of growing azimuth, z in that of growing elevation. Where n is vertical, so that
/// it has no azimuth, that is taken as zero.
template <class T>
void plane_basis(const Eigen::Matrix<T, 3, 1>& n, Eigen::Matrix<T, 3, 1>& y,
                 Eigen::Matrix<T, 3, 1>& z) {
  using std::sqrt;
  const T squared = n[0] * n[0] + n[1] * n[1];
  if (squared < T(1e-16)) {
    y = -n * n[1];
    y[1] += T(1);
    y /= y.norm();
  } else {
    const T length = sqrt(squared);
    y << -n[1] / length, n[0] / length, T(0);
  }
  z = n.cross(y);
}

/// n and c in one vector, n made a unit vector when it is read.
template <class T>
struct Plane {
  Eigen::Matrix<T, 4, 1> coefficients{T(1), T(0), T(0), T(-1)};

  Eigen::Matrix<T, 3, 1> normal() const { return coefficients.template head<3>(); }
  T distance() const { return -coefficients[3]; }
  template <class U>
  Plane<U> cast() const {
    return {coefficients.template cast<U>()};
  }
  void read(FieldReader& in) requires std::is_same_v<T, double> {
    read_field(in, coefficients);
    const double squared = coefficients.template head<3>().squaredNorm();
    if (squared < 1e-12) in.fail("normal of length zero", "a unit vector and a distance");
    if (std::abs(squared - 1.0) > 1e-14) coefficients /= std::sqrt(squared);
  }
  void write(FieldWriter& out) const requires std::is_same_v<T, double> {
    write_field(out, coefficients);
  }
};

/// A plane of the world in the frame of a pose.
template <class T>
Plane<T> seen_from(const SE3<T>& pose, const Plane<T>& plane) {
  const Eigen::Matrix<T, 3, 1> n = plane.normal();
  Plane<T> seen;
  seen.coefficients << pose.rotation().conjugate() * n,
      plane.coefficients[3] + n.dot(pose.translation());
  return seen;
}

/// Azimuth and elevation of a measured normal about the predicted one, and the difference of the
/// distances, predicted − measured.
template <class T>
void plane_error(const Plane<T>& predicted, const Plane<double>& measured,
                 Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) {
  using std::atan2;
  using std::sqrt;
  const Eigen::Matrix<T, 3, 1> n = predicted.normal(), m = measured.cast<T>().normal();
  Eigen::Matrix<T, 3, 1> y, z;
  plane_basis(n, y, z);
  const T along = n.dot(m), left = y.dot(m), up = z.dot(m);
  e[0] = atan2(left, along);
  e[1] = atan2(up, sqrt(along * along + left * left));
  e[2] = predicted.distance() - T(measured.distance());
}

/// VERTEX_PLANE: n c, and a colour (r g b) for drawing. Tangent (3): the normal's azimuth and
/// elevation about itself, the distance.
struct VertexPlane : Vertex<3, 4> {
  Eigen::Vector3d colour = Eigen::Vector3d::Constant(0.2);  ///< not part of the state

  template <class T>
  using View = Plane<T>;
  template <class T>
  static View<T> view(const T* s) {
    return {Eigen::Matrix<T, 4, 1>(s[0], s[1], s[2], s[3])};
  }
  template <class T>
  static void oplus(const T* s, const T* d, T* out) {
    const Eigen::Matrix<T, 3, 1> n(s[0], s[1], s[2]);
    Eigen::Matrix<T, 3, 1> y, z;
    plane_basis(n, y, z);
    const Eigen::Matrix<T, 3, 1> turned = n + y * d[0] + z * d[1];
    const T length = turned.norm();
    for (int i = 0; i < 3; ++i) out[i] = turned[i] / length;
    out[3] = s[3] - d[2];
  }
  static void store(const Plane<double>& plane, double* s) {
    for (int i = 0; i < 4; ++i) s[i] = plane.coefficients[i];
  }
  VertexPlane() { store(Plane<double>(), state.data()); }
  explicit VertexPlane(const Plane<double>& plane) { store(plane, state.data()); }
  void read(FieldReader& in);
  void write(FieldWriter& out) const;
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_PLANE", VertexPlane)

/// EDGE_SE3_PLANE: a plane seen from a pose, as hdl_graph_slam writes it. Error (3): plane_error().
struct EdgeSE3Plane : Edge<3, VertexSE3, VertexPlane> {
  Plane<double> measurement;
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE3<T>& a, const Plane<T>& plane, Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    plane_error<T>(seen_from(a, plane), measurement, e);
  }
  Plane<double> predict_second(const SE3<double>& a) const {
    return seen_from(a.inverse(), measurement);
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE3_PLANE", EdgeSE3Plane)

/// EDGE_SE3_PLANE_CALIB: a plane seen by a sensor whose mount C is estimated. Fields: plane, colour
/// for drawing. Error (3): plane_error() in A·C.
struct EdgeSE3PlaneCalib : Edge<3, VertexSE3, VertexPlane, VertexSE3> {
  Plane<double> measurement;
  Eigen::Vector3d colour = Eigen::Vector3d::Constant(0.1);
  auto fields() { return std::tie(measurement, colour); }

  template <class T>
  void error(const SE3<T>& a, const Plane<T>& plane, const SE3<T>& mount,
             Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    plane_error<T>(seen_from(a * mount, plane), measurement, e);
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE3_PLANE_CALIB", EdgeSE3PlaneCalib)

/// EDGE_PLANE: difference of two planes. Error (4): coefficients of Q − those of P − z.
struct EdgePlane : Edge<4, VertexPlane, VertexPlane> {
  Eigen::Vector4d measurement = Eigen::Vector4d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const Plane<T>& p, const Plane<T>& q, Eigen::Ref<Eigen::Matrix<T, 4, 1>> e) const {
    e = q.coefficients - p.coefficients - measurement.template cast<T>();
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_PLANE", EdgePlane)

/// w and d of a line; made w ⟂ d and |d| = 1 when it is read.
template <class T>
struct Line3 {
  Eigen::Matrix<T, 3, 1> moment{T(0), T(0), T(0)};     ///< w
  Eigen::Matrix<T, 3, 1> direction{T(1), T(0), T(0)};  ///< d

  template <class U>
  Line3<U> cast() const {
    return {moment.template cast<U>(), direction.template cast<U>()};
  }
  void read(FieldReader& in) requires std::is_same_v<T, double> {
    read_field(in, moment);
    read_field(in, direction);
    const double squared = direction.squaredNorm();
    if (squared < 1e-12) in.fail("direction of length zero", "Plücker coordinates w d, d not zero");
    if (std::abs(squared - 1.0) > 1e-14) {
      moment /= std::sqrt(squared);
      direction /= std::sqrt(squared);
    }
    const double along = moment.dot(direction);
    if (std::abs(along) > 1e-14 * (1.0 + moment.norm())) moment -= along * direction;
  }
  void write(FieldWriter& out) const requires std::is_same_v<T, double> {
    write_field(out, moment);
    write_field(out, direction);
  }
};

/// The orthonormal representation (Bartoli and Sturm 2005, section 4.1): axes (w/|w|, d, w/|w| × d)
/// and the vector (|w|, |d|) made of length one. A line through the origin has any w/|w|.
template <class T>
struct OrthonormalLine {
  Eigen::Matrix<T, 3, 3> axes;
  Eigen::Matrix<T, 2, 1> lengths;
  explicit OrthonormalLine(const Line3<T>& line) {
    using std::sqrt;
    const T w_squared = line.moment.squaredNorm();
    const T d_length = line.direction.norm();
    axes.col(1) = line.direction / d_length;
    if (w_squared < T(1e-24)) {
      Eigen::Matrix<T, 3, 1> y, z;
      plane_basis(Eigen::Matrix<T, 3, 1>(axes.col(1)), y, z);
      axes.col(0) = y;
      lengths << T(0), d_length;
    } else {
      const T w_length = sqrt(w_squared);
      axes.col(0) = line.moment / w_length;
      lengths << w_length, d_length;
    }
    axes.col(2) = axes.col(0).cross(axes.col(1));
    lengths /= lengths.norm();
  }
};

/// VERTEX_LINE3D: w d. Tangent (4): vector part of the quaternion that turns the axes, angle that
/// turns the lengths.
struct VertexLine3D : Vertex<4, 6> {
  template <class T>
  using View = Line3<T>;
  template <class T>
  static View<T> view(const T* s) {
    return {{s[0], s[1], s[2]}, {s[3], s[4], s[5]}};
  }
  template <class T>
  static void oplus(const T* s, const T* d, T* out);
  static void store(const Line3<double>& line, double* s) {
    for (int i = 0; i < 3; ++i) s[i] = line.moment[i];
    for (int i = 0; i < 3; ++i) s[3 + i] = line.direction[i];
  }
  VertexLine3D() { store(Line3<double>(), state.data()); }
  explicit VertexLine3D(const Line3<double>& line) { store(line, state.data()); }
  void read(FieldReader& in);
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_LINE3D", VertexLine3D)

template <class T>
void VertexLine3D::oplus(const T* s, const T* d, T* out) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const OrthonormalLine<T> line(view(s));
  const Eigen::Matrix<T, 3, 1> v(d[0], d[1], d[2]);
  const T squared = v.squaredNorm();
  // Longer than one it is no vector part any more: half a turn about it.
  Eigen::Quaternion<T> turn(squared < T(1) ? T(sqrt(T(1) - squared)) : T(0), v[0], v[1], v[2]);
  turn.normalize();
  const Eigen::Matrix<T, 3, 3> axes = line.axes * turn.toRotationMatrix();
  const T c = cos(d[3]), sn = sin(d[3]);
  // The lengths are the first column of [w −d; d w]; turned, the first column of the product.
  const T w = line.lengths[0] * c - line.lengths[1] * sn;
  const T l = line.lengths[1] * c + line.lengths[0] * sn;
  const T sign = l < T(0) ? T(-1) : T(1);
  for (int i = 0; i < 3; ++i) {
    out[i] = axes(i, 0) * w / (sign * l);
    out[3 + i] = axes(i, 1) * sign;
  }
}

/// EDGE_SE3_LINE3D: a line seen from a pose. Fields: number of a PARAMS_SE3OFFSET, which is named
/// and kept but does not enter (g2o computes it so), w d of the measurement. Error (4): what turns
/// the axes and the lengths of the predicted line into those of the measured one, as the tangent of
/// VERTEX_LINE3D. A line through the pose itself has no such axes and is no good measurement.
struct EdgeSE3Line3D : Edge<4, VertexSE3, VertexLine3D> {
  int offset_number = 0;
  Line3<double> measurement;
  auto fields() { return std::tie(offset_number, measurement); }
  void bind(const Parameters& parameters);

  template <class T>
  void error(const SE3<T>& a, const Line3<T>& line, Eigen::Ref<Eigen::Matrix<T, 4, 1>> e) const {
    using std::atan2;
    const Eigen::Quaternion<T> back = a.rotation().conjugate();
    const Line3<T> seen{back * (line.moment - a.translation().cross(line.direction)),
                        back * line.direction};
    const OrthonormalLine<T> p(seen), m(measurement.template cast<T>());
    const Eigen::Matrix<T, 3, 3> turn = p.axes.transpose() * m.axes;
    Eigen::Quaternion<T> q(turn);
    q.normalize();
    const T sign = q.w() < T(0) ? T(-1) : T(1);
    e.template head<3>() = sign * q.vec();
    e[3] =
        atan2(p.lengths[0] * m.lengths[1] - p.lengths[1] * m.lengths[0], p.lengths.dot(m.lengths));
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE3_LINE3D", EdgeSE3Line3D)

// Compiled once, with the registration.
extern template class TypedVertexPool<VertexPlane>;
extern template class TypedVertexPool<VertexLine3D>;
extern template class TypedEdgePool<EdgeSE3Plane>;
extern template class TypedEdgePool<EdgeSE3PlaneCalib>;
extern template class TypedEdgePool<EdgePlane>;
extern template class TypedEdgePool<EdgeSE3Line3D>;

/// Everything above.
void add_slam3d_plane_and_line_types(TypeRegistry& types);

}  // namespace locograph
