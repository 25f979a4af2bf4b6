#pragma once
/// Planar edges that calibrate while they estimate: where a sensor sits, and the odometry of a
/// differential drive.
///
/// The mount of a sensor is a VERTEX_SE2 like any other, shared by all edges of that sensor.

#include <locograph/core/type_registry.h>
#include <locograph/core/typed_edge_pool.h>
#include <locograph/types/slam2d/edges.h>

namespace locograph {

/// EDGE_SE2_XY_CALIB: a point seen by a sensor whose mount C is estimated. Error (2) [m]:
/// (A·C)⁻¹ p − z.
struct EdgeSE2XYCalib : Edge<2, VertexSE2, VertexXY, VertexSE2> {
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE2<T>& a, const Eigen::Matrix<T, 2, 1>& p, const SE2<T>& mount,
             Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    const SE2<T> sensor = a * mount;
    e = sensor.inverse_rotate(p - sensor.translation()) - measurement.template cast<T>();
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE2_XY_CALIB", EdgeSE2XYCalib)

/// EDGE_SE2_CALIB: relative pose of a sensor whose mount C is estimated. Error (3): as EDGE_SE2, of
/// A·C and B·C.
struct EdgeSE2Calib : Edge<3, VertexSE2, VertexSE2, VertexSE2> {
  SE2<double> measurement;
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE2<T>& a, const SE2<T>& b, const SE2<T>& mount,
             Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    EdgeSE2 between;
    between.measurement = measurement;
    between.error<T>(a * mount, b * mount, e);
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE2_CALIB", EdgeSE2Calib)

/// VERTEX_ODOM_DIFFERENTIAL: factors of the left and the right wheel's velocity, and the distance
/// between the wheels [m]. Tangent (3): added.
struct VertexOdomDifferential : Vertex<3, 3> {
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
  VertexOdomDifferential() { state.setOnes(); }
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_ODOM_DIFFERENTIAL", VertexOdomDifferential)

/// EDGE_SE2_ODOM_DIFFERENTIAL_CALIB: what the wheels say of the motion from A to B. Fields:
/// velocities of the left and the right wheel [m/s], duration [s]. Error (3): as EDGE_SE2, the
/// measurement being the arc that the calibrated wheels drive.
struct EdgeSE2OdomDifferentialCalib : Edge<3, VertexSE2, VertexSE2, VertexOdomDifferential> {
  double left_m_s = 0.0, right_m_s = 0.0, duration_s = 0.0;
  auto fields() { return std::tie(left_m_s, right_m_s, duration_s); }

  /// The arc: heading changes by θ = (r − l) dt / distance, the way is v dt, v = (l + r) / 2; so
  /// x = v dt sin θ / θ, y = v dt (1 − cos θ) / θ.
  template <class T>
  SE2<T> arc(const Eigen::Matrix<T, 3, 1>& wheels) const {
    using std::cos;
    using std::sin;
    const T left = wheels[0] * T(left_m_s), right = wheels[1] * T(right_m_s);
    const T angle = (right - left) * T(duration_s) / wheels[2];
    const T way = T(0.5 * duration_s) * (left + right);
    const T squared = angle * angle;
    if (squared < T(1e-8)) {
      return SE2<T>(way * (T(1) - squared / T(6)), way * angle / T(2), angle);
    }
    return SE2<T>(way * sin(angle) / angle, way * (T(1) - cos(angle)) / angle, angle);
  }

  template <class T>
  void error(const SE2<T>& a, const SE2<T>& b, const Eigen::Matrix<T, 3, 1>& wheels,
             Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    const SE2<T> z = arc(wheels);
    const Eigen::Matrix<T, 2, 1> between = a.inverse_rotate(b.translation() - a.translation());
    e.template head<2>() = z.inverse_rotate(between - z.translation());
    e[2] = wrap_angle(T(b.angle() - a.angle() - z.angle()));
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE2_ODOM_DIFFERENTIAL_CALIB", EdgeSE2OdomDifferentialCalib)

// Compiled once, with the registration.
extern template class TypedVertexPool<VertexOdomDifferential>;
extern template class TypedEdgePool<EdgeSE2XYCalib>;
extern template class TypedEdgePool<EdgeSE2Calib>;
extern template class TypedEdgePool<EdgeSE2OdomDifferentialCalib>;

/// Everything above.
void add_slam2d_calibration_types(TypeRegistry& types);

}  // namespace locograph
