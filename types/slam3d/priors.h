#pragma once
/// What is known of a single pose or point in space: where it is, and where down is.
///
///     EdgeSE3PriorVec gravity;                          // an accelerometer at rest
///     gravity.direction = -Eigen::Vector3d::UnitZ();    // in the world
///     gravity.measurement = down_in_the_sensor;

#include <locograph/core/type_registry.h>
#include <locograph/core/typed_edge_pool.h>
#include <locograph/types/slam3d/edges.h>

namespace locograph {

/// A direction: made a unit vector when it is read, unless it is one already.
struct UnitVector3 : Eigen::Vector3d {
  UnitVector3() : Eigen::Vector3d(Eigen::Vector3d::UnitZ()) {}
  using Eigen::Vector3d::operator=;
  void read(FieldReader& in) {
    for (int i = 0; i < 3; ++i) (*this)[i] = in.number();
    const double squared = squaredNorm();
    if (squared < 1e-12) in.fail("direction of length zero", "a unit vector");
    if (std::abs(squared - 1.0) > 1e-14) *this /= std::sqrt(squared);
  }
  void write(FieldWriter& out) const {
    for (int i = 0; i < 3; ++i) out.number((*this)[i]);
  }
};

/// EDGE_SE3_PRIOR: absolute pose of a sensor. Fields: number of the PARAMS_SE3OFFSET, measurement.
/// Error (6): pose_error of Z⁻¹ (A·o).
struct EdgeSE3Prior : Edge<6, VertexSE3> {
  int offset_number = 0;
  SE3<double> measurement;
  SE3<double> offset;  ///< looked up by bind()
  auto fields() { return std::tie(offset_number, measurement); }
  void bind(const Parameters& parameters) {
    offset = parameters.get<OffsetSE3>(offset_number)->offset;
  }

  template <class T>
  void error(const SE3<T>& a, Eigen::Ref<Eigen::Matrix<T, 6, 1>> e) const {
    pose_error<T>(measurement.template cast<T>().inverse() * (a * offset.template cast<T>()), e);
  }
  void jacobians(const SE3<double>& a, JacobianRef<EdgeSE3Prior, 0> ja) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE3_PRIOR", EdgeSE3Prior)

/// EDGE_SE3_XYZ_PRIOR, also read as EDGE_SE3_XYZPRIOR: absolute position of a pose. Fields: number
/// of a PARAMS_SE3OFFSET, measurement. Error (3) [m]: t − z. The offset is named and kept but does
/// not enter: g2o computes it so.
struct EdgeSE3XYZPrior : Edge<3, VertexSE3> {
  int offset_number = 0;
  Eigen::Vector3d measurement = Eigen::Vector3d::Zero();
  auto fields() { return std::tie(offset_number, measurement); }
  void bind(const Parameters& parameters) { parameters.get<OffsetSE3>(offset_number); }

  template <class T>
  void error(const SE3<T>& a, Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    e = a.translation() - measurement.template cast<T>();
  }
  void jacobians(const SE3<double>& a, JacobianRef<EdgeSE3XYZPrior, 0> ja) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE3_XYZ_PRIOR", EdgeSE3XYZPrior)

/// EDGE_SE3_PRIORXYZ: the same without an offset, as hdl_graph_slam writes it (GPS).
struct EdgeSE3PriorXYZ : Edge<3, VertexSE3> {
  Eigen::Vector3d measurement = Eigen::Vector3d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE3<T>& a, Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    e = a.translation() - measurement.template cast<T>();
  }
  void jacobians(const SE3<double>& a, JacobianRef<EdgeSE3PriorXYZ, 0> ja) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE3_PRIORXYZ", EdgeSE3PriorXYZ)

/// EDGE_SE3_PRIORXY: the first two coordinates only. Error (2) [m].
struct EdgeSE3PriorXY : Edge<2, VertexSE3> {
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const SE3<T>& a, Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    e = a.translation().template head<2>() - measurement.template cast<T>();
  }
  void jacobians(const SE3<double>& a, JacobianRef<EdgeSE3PriorXY, 0> ja) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE3_PRIORXY", EdgeSE3PriorXY)

/// EDGE_SE3_PRIORVEC: a direction of the world seen from a pose, gravity for instance. Fields:
/// direction in the world, the same as measured in the pose (both are made unit vectors). Error
/// (3): Rᵀ direction − measurement. As hdl_graph_slam writes it.
struct EdgeSE3PriorVec : Edge<3, VertexSE3> {
  UnitVector3 direction, measurement;
  auto fields() { return std::tie(direction, measurement); }

  template <class T>
  void error(const SE3<T>& a, Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    e = a.rotation().conjugate() * Eigen::Matrix<T, 3, 1>(direction.template cast<T>()) -
        measurement.template cast<T>();
  }
  void jacobians(const SE3<double>& a, JacobianRef<EdgeSE3PriorVec, 0> ja) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_SE3_PRIORVEC", EdgeSE3PriorVec)

/// EDGE_POINTXYZ_PRIOR, also read as EDGE_POINT_XYZ_PRIOR and EDGE_XYZ_PRIOR: absolute position of
/// a point. Error (3) [m]: p − z.
struct EdgePointXYZPrior : Edge<3, VertexPointXYZ> {
  Eigen::Vector3d measurement = Eigen::Vector3d::Zero();
  auto fields() { return std::tie(measurement); }

  template <class T>
  void error(const Eigen::Matrix<T, 3, 1>& p, Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    e = p - measurement.template cast<T>();
  }
  void jacobians(const Eigen::Vector3d&, JacobianRef<EdgePointXYZPrior, 0> jp) const {
    jp.setIdentity();
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_POINTXYZ_PRIOR", EdgePointXYZPrior)

// Compiled once, with the registration.
extern template class TypedEdgePool<EdgeSE3Prior>;
extern template class TypedEdgePool<EdgeSE3XYZPrior>;
extern template class TypedEdgePool<EdgeSE3PriorXYZ>;
extern template class TypedEdgePool<EdgeSE3PriorXY>;
extern template class TypedEdgePool<EdgeSE3PriorVec>;
extern template class TypedEdgePool<EdgePointXYZPrior>;

/// Everything above.
void add_slam3d_prior_types(TypeRegistry& types);

}  // namespace locograph
