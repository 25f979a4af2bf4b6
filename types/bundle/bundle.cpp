#include <locograph/common/skew.h>
#include <locograph/types/bundle/bundle.h>
#include <locograph/types/bundle/camera_bal.h>
#include <locograph/types/bundle/camera_view.h>
#include <locograph/types/bundle/inverse_depth.h>
#include <locograph/types/bundle/pinhole.h>

namespace locograph {
template class TypedVertexPool<VertexCam>;
template class TypedEdgePool<EdgeProjectP2MC>;
template class TypedEdgePool<EdgeProjectP2SC>;
template class TypedVertexPool<VertexInverseDepth>;
template class TypedEdgePool<EdgeProjectInverseDepth>;
template class TypedEdgePool<EdgeProjectPinhole>;
template class TypedEdgePool<EdgeProjectStereo>;

namespace {

/// A point in the frame of a camera and its derivatives: by the tangent of the pose that carries
/// the camera, and by the point.
struct SeenPoint {
  Eigen::Vector3d in_camera;
  Eigen::Matrix<double, 3, 6> by_pose;
  Eigen::Matrix3d by_point;
};

SeenPoint see(const SE3<double>& pose, const SE3<double>& offset, const Eigen::Vector3d& point) {
  // With A ← A exp(d): A⁻¹ X changes by −d_t + (A⁻¹ X) × d_r.
  const Eigen::Matrix3d pose_from_world = pose.rotation().conjugate().toRotationMatrix();
  const Eigen::Matrix3d camera_from_pose = offset.rotation().conjugate().toRotationMatrix();
  const Eigen::Vector3d in_pose = pose_from_world * (point - pose.translation());
  SeenPoint seen;
  seen.in_camera = camera_from_pose * (in_pose - offset.translation());
  seen.by_pose.leftCols<3>() = -camera_from_pose;
  seen.by_pose.rightCols<3>() = camera_from_pose * skew(in_pose);
  seen.by_point = camera_from_pose * pose_from_world;
  return seen;
}

/// ∂(f x / z)/∂(x, y, z), x the coordinate `axis` less `shift`.
Eigen::RowVector3d image_row(double focal, const Eigen::Vector3d& c, int axis, double shift = 0.0) {
  Eigen::RowVector3d row = Eigen::RowVector3d::Zero();
  row[axis] = focal / c[2];
  row[2] = -focal * (c[axis] - shift) / (c[2] * c[2]);
  return row;
}

void check_calibration(FieldReader& in, double fx, double fy) {
  if (fx == 0.0 || fy == 0.0) in.fail("focal length of zero", "fx and fy other than zero");
}

}  // namespace

void StereoCalibration::read(FieldReader& in) {
  offset.read(in);
  read_fields(in, std::tie(fx, fy, cx, cy, baseline_m));
  check_calibration(in, fx, fy);
  if (baseline_m == 0.0) in.fail("baseline of zero", "a baseline other than zero");
}

void StereoCalibration::write(FieldWriter& out) const {
  offset.write(out);
  for (const double value : {fx, fy, cx, cy, baseline_m}) out.number(value);
}

void VertexCam::read(FieldReader& in) {
  SE3<double> pose;
  pose.read(in);
  pose.store(state.data());
  for (int i = 7; i < 12; ++i) state[i] = in.number();
  check_calibration(in, state[7], state[8]);
}

void EdgeProjectPinhole::jacobians(const SE3<double>& a, const Eigen::Vector3d& point,
                                   JacobianRef<EdgeProjectPinhole, 0> ja,
                                   JacobianRef<EdgeProjectPinhole, 1> jp) const {
  const SeenPoint seen = see(a, camera->offset, point);
  Eigen::Matrix<double, 2, 3> image;
  image << image_row(camera->fx, seen.in_camera, 0), image_row(camera->fy, seen.in_camera, 1);
  ja = image * seen.by_pose;
  jp = image * seen.by_point;
}

void EdgeProjectStereo::jacobians(const SE3<double>& a, const Eigen::Vector3d& point,
                                  JacobianRef<EdgeProjectStereo, 0> ja,
                                  JacobianRef<EdgeProjectStereo, 1> jp) const {
  const SeenPoint seen = see(a, camera->offset, point);
  Eigen::Matrix3d image;
  image << image_row(camera->fx, seen.in_camera, 0), image_row(camera->fy, seen.in_camera, 1),
      image_row(camera->fx, seen.in_camera, 0, camera->baseline_m);
  ja = image * seen.by_pose;
  jp = image * seen.by_point;
}

void EdgeProjectP2MC::jacobians(const Eigen::Vector3d& point, const CameraView<double>& camera,
                                JacobianRef<EdgeProjectP2MC, 0> jp,
                                JacobianRef<EdgeProjectP2MC, 1> jc) const {
  const SeenPoint seen = see(camera.world_from_camera, SE3<double>(), point);
  Eigen::Matrix<double, 2, 3> image;
  image << image_row(camera.fx, seen.in_camera, 0), image_row(camera.fy, seen.in_camera, 1);
  jp = image * seen.by_point;
  jc = image * seen.by_pose;
}

void EdgeProjectP2SC::jacobians(const Eigen::Vector3d& point, const CameraView<double>& camera,
                                JacobianRef<EdgeProjectP2SC, 0> jp,
                                JacobianRef<EdgeProjectP2SC, 1> jc) const {
  const SeenPoint seen = see(camera.world_from_camera, SE3<double>(), point);
  Eigen::Matrix3d image;
  image << image_row(camera.fx, seen.in_camera, 0), image_row(camera.fy, seen.in_camera, 1),
      image_row(camera.fx, seen.in_camera, 0, camera.baseline_m);
  jp = image * seen.by_point;
  jc = image * seen.by_pose;
}

void add_bundle_types(TypeRegistry& types) {
  types.add_parameter<StereoCalibration>("PARAMS_STEREOCALIB");
  types.add_vertex<VertexCameraBAL>();
  types.add_vertex<VertexCam>();
  types.add_vertex<VertexInverseDepth>();
  types.add_edge<EdgeProjectBAL>();
  types.add_edge<EdgeProjectPinhole>();
  types.add_edge<EdgeProjectStereo>();
  types.add_edge<EdgeProjectP2MC>();
  types.add_edge<EdgeProjectP2SC>();
  types.add_edge<EdgeProjectInverseDepth>();
}

}  // namespace locograph
