#include <locograph/common/skew.h>
#include <locograph/types/slam3d/priors.h>

namespace locograph {
template class TypedEdgePool<EdgeSE3Prior>;
template class TypedEdgePool<EdgeSE3XYZPrior>;
template class TypedEdgePool<EdgeSE3PriorXYZ>;
template class TypedEdgePool<EdgeSE3PriorXY>;
template class TypedEdgePool<EdgeSE3PriorVec>;
template class TypedEdgePool<EdgePointXYZPrior>;

namespace {

/// Of the position by the step of its pose, which is in the pose's own frame.
Eigen::Matrix<double, 3, 6> position_by_pose(const SE3<double>& a) {
  Eigen::Matrix<double, 3, 6> m = Eigen::Matrix<double, 3, 6>::Zero();
  m.leftCols<3>() = a.rotation().toRotationMatrix();
  return m;
}

}  // namespace

void EdgeSE3Prior::jacobians(const SE3<double>& a, JacobianRef<EdgeSE3Prior, 0> ja) const {
  // E = Z⁻¹ A exp(d) O: its position changes by R_zᵀ R_a (d_t − o × d_r), its quaternion by
  // ½ q_e ⊗ (0, R_oᵀ d_r).
  const Eigen::Quaterniond back = measurement.rotation().conjugate() * a.rotation();
  const Eigen::Quaterniond e = back * offset.rotation();
  const double half = e.w() < 0.0 ? -0.5 : 0.5;
  const Eigen::Matrix3d r = back.toRotationMatrix();
  ja.topLeftCorner<3, 3>() = r;
  ja.topRightCorner<3, 3>() = -r * skew(offset.translation());
  ja.bottomLeftCorner<3, 3>().setZero();
  ja.bottomRightCorner<3, 3>() = half * (e.w() * Eigen::Matrix3d::Identity() + skew(e.vec())) *
                                 offset.rotation().conjugate().toRotationMatrix();
}

void EdgeSE3XYZPrior::jacobians(const SE3<double>& a, JacobianRef<EdgeSE3XYZPrior, 0> ja) const {
  ja = position_by_pose(a);
}

void EdgeSE3PriorXYZ::jacobians(const SE3<double>& a, JacobianRef<EdgeSE3PriorXYZ, 0> ja) const {
  ja = position_by_pose(a);
}

void EdgeSE3PriorXY::jacobians(const SE3<double>& a, JacobianRef<EdgeSE3PriorXY, 0> ja) const {
  ja = position_by_pose(a).topRows<2>();
}

void EdgeSE3PriorVec::jacobians(const SE3<double>& a, JacobianRef<EdgeSE3PriorVec, 0> ja) const {
  // Rotated further by d_r, v = Rᵀ direction becomes v − d_r × v = v + v × d_r.
  ja.leftCols<3>().setZero();
  ja.rightCols<3>() = skew(a.rotation().conjugate() * direction);
}

void add_slam3d_prior_types(TypeRegistry& types) {
  types.add_edge<EdgeSE3Prior>();
  types.add_edge<EdgeSE3XYZPrior>();
  types.add_edge_alias<EdgeSE3XYZPrior>("EDGE_SE3_XYZPRIOR");
  types.add_edge<EdgeSE3PriorXYZ>();
  types.add_edge<EdgeSE3PriorXY>();
  types.add_edge<EdgeSE3PriorVec>();
  types.add_edge<EdgePointXYZPrior>();
  types.add_edge_alias<EdgePointXYZPrior>("EDGE_POINT_XYZ_PRIOR");
  types.add_edge_alias<EdgePointXYZPrior>("EDGE_XYZ_PRIOR");
}

}  // namespace locograph
