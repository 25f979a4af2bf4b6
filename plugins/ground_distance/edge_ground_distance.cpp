#include <locograph/plugins/ground_distance/edge_ground_distance.h>

namespace locograph {

template class TypedEdgePool<EdgeGroundDistance>;

EdgeGroundDistance::EdgeGroundDistance(const RobotParameter& robot, double margin, double weight)
    : margin_m(margin) {
  weights.setConstant(static_cast<Eigen::Index>(robot.spheres.size()), weight);
}

void EdgeGroundDistance::error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const {
  require_rows(kTag, e.size(), static_cast<long>(q.robot->spheres.size()));
  for (Eigen::Index i = 0; i < q.sphere_centres.rows(); ++i) {
    e[i] = std::max(0.0, margin_m + q.robot->spheres[i].radius - q.sphere_centre(i).z());
  }
}

void EdgeGroundDistance::jacobians(const ConfigurationState& q,
                                   JacobianRef<EdgeGroundDistance, 0> j) const {
  for (Eigen::Index i = 0; i < q.sphere_centres.rows(); ++i) {
    const CollisionSphere& sphere = q.robot->spheres[i];
    if (margin_m + sphere.radius - q.sphere_centre(i).z() <= 0.0) continue;
    q.kinematics.add_point_gradient(sphere.link, q.sphere_centre(i), Eigen::Vector3d::UnitZ(), -1.0,
                                    j.row(i).data());
  }
}

}  // namespace locograph
