#pragma once
/// Pinhole and stereo cameras with a calibration shared by many images, carried by a VERTEX_SE3.
///
///     PARAMS_CAMERACALIB 0  0 0 0 0 0 0 1  700 700 320 240
///     VERTEX_SE3:QUAT 0  0 0 0 0 0 0 1
///     VERTEX_TRACKXYZ 1  0.5 0.2 4
///     EDGE_PROJECT_PINHOLE 0 1  0  407.5 275  1 0 1
///
/// A camera looks along its positive z axis; c = (A·o)⁻¹ X is the point in its frame [m], o the
/// offset of the calibration.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/types/slam3d/parameters.h>
#include <locograph/types/slam3d/vertices.h>

#include <memory>

namespace locograph {

/// PARAMS_STEREOCALIB: offset (x y z qx qy qz qw), fx fy cx cy [px], baseline [m] from the left
/// camera, which the offset places, to the right one.
struct StereoCalibration final : OffsetSE3 {
  double fx = 1.0, fy = 1.0, cx = 0.0, cy = 0.0, baseline_m = 1.0;
  std::string_view tag() const override { return "PARAMS_STEREOCALIB"; }
  void read(FieldReader& in) override;
  void write(FieldWriter& out) const override;
};

/// EDGE_PROJECT_PINHOLE. Fields: number of the PARAMS_CAMERACALIB, u v. Error (2) [px]: predicted
/// − measured, u = fx c_x / c_z + cx and v alike.
struct EdgeProjectPinhole : Edge<2, VertexSE3, VertexPointXYZ> {
  int camera_number = 0;
  Eigen::Vector2d measurement = Eigen::Vector2d::Zero();
  std::shared_ptr<const CameraCalibration> camera;  ///< looked up by bind()
  auto fields() { return std::tie(camera_number, measurement); }
  void bind(const Parameters& parameters) {
    camera = parameters.get<CameraCalibration>(camera_number);
  }

  template <class T>
  void error(const SE3<T>& a, const Eigen::Matrix<T, 3, 1>& point,
             Eigen::Ref<Eigen::Matrix<T, 2, 1>> e) const {
    const SE3<T> sensor = a * camera->offset.template cast<T>();
    const Eigen::Matrix<T, 3, 1> c = sensor.rotation().conjugate() * (point - sensor.translation());
    e[0] = T(camera->fx) * c[0] / c[2] + T(camera->cx) - T(measurement[0]);
    e[1] = T(camera->fy) * c[1] / c[2] + T(camera->cy) - T(measurement[1]);
  }
  void jacobians(const SE3<double>& a, const Eigen::Vector3d& point,
                 JacobianRef<EdgeProjectPinhole, 0> ja,
                 JacobianRef<EdgeProjectPinhole, 1> jp) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_PROJECT_PINHOLE", EdgeProjectPinhole)

/// EDGE_PROJECT_STEREO. Fields: number of the PARAMS_STEREOCALIB, u v u_right. Error (3) [px]:
/// predicted − measured, u_right = fx (c_x − baseline) / c_z + cx.
struct EdgeProjectStereo : Edge<3, VertexSE3, VertexPointXYZ> {
  int camera_number = 0;
  Eigen::Vector3d measurement = Eigen::Vector3d::Zero();
  std::shared_ptr<const StereoCalibration> camera;
  auto fields() { return std::tie(camera_number, measurement); }
  void bind(const Parameters& parameters) {
    camera = parameters.get<StereoCalibration>(camera_number);
  }

  template <class T>
  void error(const SE3<T>& a, const Eigen::Matrix<T, 3, 1>& point,
             Eigen::Ref<Eigen::Matrix<T, 3, 1>> e) const {
    const SE3<T> sensor = a * camera->offset.template cast<T>();
    const Eigen::Matrix<T, 3, 1> c = sensor.rotation().conjugate() * (point - sensor.translation());
    e[0] = T(camera->fx) * c[0] / c[2] + T(camera->cx) - T(measurement[0]);
    e[1] = T(camera->fy) * c[1] / c[2] + T(camera->cy) - T(measurement[1]);
    e[2] =
        T(camera->fx) * (c[0] - T(camera->baseline_m)) / c[2] + T(camera->cx) - T(measurement[2]);
  }
  void jacobians(const SE3<double>& a, const Eigen::Vector3d& point,
                 JacobianRef<EdgeProjectStereo, 0> ja, JacobianRef<EdgeProjectStereo, 1> jp) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_PROJECT_STEREO", EdgeProjectStereo)

// Compiled once, with the registration.
extern template class TypedEdgePool<EdgeProjectPinhole>;
extern template class TypedEdgePool<EdgeProjectStereo>;

}  // namespace locograph
