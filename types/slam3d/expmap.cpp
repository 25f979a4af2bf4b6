#include <locograph/common/skew.h>
#include <locograph/types/slam3d/expmap.h>

namespace locograph {
template class TypedVertexPool<VertexSE3Expmap>;
template class TypedEdgePool<EdgeSE3Expmap>;
template class TypedEdgePool<EdgeProjectXYZ2UV>;
template class TypedEdgePool<EdgeProjectXYZ2UVU>;

namespace {

/// A point in the camera, and the derivatives of that by point and pose.
struct PointInCamera {
  Eigen::Vector3d c;
  PointInCamera(const Eigen::Vector3d& p, const SE3<double>& a)
      : c(a.rotation().conjugate() * (p - a.translation())) {}

  Eigen::Matrix3d by_point(const SE3<double>& a) const {
    return a.rotation().conjugate().toRotationMatrix();
  }
  Eigen::Matrix<double, 3, 6> by_pose() const {
    Eigen::Matrix<double, 3, 6> m;
    m << -Eigen::Matrix3d::Identity(), skew(c);
    return m;
  }
  /// Of one image coordinate f (c_axis − shift) / c_z.
  Eigen::RowVector3d image_row(double focal, int axis, double shift) const {
    Eigen::RowVector3d row = Eigen::RowVector3d::Zero();
    row[axis] = focal / c[2];
    row[2] = -focal * (c[axis] - shift) / (c[2] * c[2]);
    return row;
  }
};

}  // namespace

void EdgeProjectXYZ2UV::error(const Eigen::Vector3d& p, const SE3<double>& a,
                              Eigen::Ref<Eigen::Vector2d> e) const {
  const PointInCamera point(p, a);
  const double scale = camera->focal_px / point.c[2];
  e[0] = measurement[0] - (scale * point.c[0] + camera->u_px);
  e[1] = measurement[1] - (scale * point.c[1] + camera->v_px);
}

void EdgeProjectXYZ2UV::jacobians(const Eigen::Vector3d& p, const SE3<double>& a,
                                  JacobianRef<EdgeProjectXYZ2UV, 0> jp,
                                  JacobianRef<EdgeProjectXYZ2UV, 1> ja) const {
  const PointInCamera point(p, a);
  Eigen::Matrix<double, 2, 3> image;
  image << point.image_row(camera->focal_px, 0, 0.0), point.image_row(camera->focal_px, 1, 0.0);
  jp = -image * point.by_point(a);
  ja = -image * point.by_pose();
}

void EdgeProjectXYZ2UVU::error(const Eigen::Vector3d& p, const SE3<double>& a,
                               Eigen::Ref<Eigen::Vector3d> e) const {
  const PointInCamera point(p, a);
  const double scale = camera->focal_px / point.c[2];
  e[0] = measurement[0] - (scale * point.c[0] + camera->u_px);
  e[1] = measurement[1] - (scale * point.c[1] + camera->v_px);
  e[2] = measurement[2] - (scale * (point.c[0] - camera->baseline_m) + camera->u_px);
}

void EdgeProjectXYZ2UVU::jacobians(const Eigen::Vector3d& p, const SE3<double>& a,
                                   JacobianRef<EdgeProjectXYZ2UVU, 0> jp,
                                   JacobianRef<EdgeProjectXYZ2UVU, 1> ja) const {
  const PointInCamera point(p, a);
  Eigen::Matrix3d image;
  image << point.image_row(camera->focal_px, 0, 0.0), point.image_row(camera->focal_px, 1, 0.0),
      point.image_row(camera->focal_px, 0, camera->baseline_m);
  jp = -image * point.by_point(a);
  ja = -image * point.by_pose();
}

void add_slam3d_expmap_types(TypeRegistry& types) {
  types.add_parameter<PinholeCamera>("PARAMS_CAMERAPARAMETERS");
  types.add_vertex<VertexSE3Expmap>();
  types.add_edge<EdgeSE3Expmap>();
  types.add_edge<EdgeProjectXYZ2UV>();
  types.add_edge<EdgeProjectXYZ2UVU>();
}

}  // namespace locograph
