#include <locograph/plugins/obstacle_distance/edge_obstacle_distance.h>

namespace locograph {

template class TypedEdgePool<EdgeObstacleDistance>;

EdgeObstacleDistance::EdgeObstacleDistance(const RobotParameter& robot, int number, double margin,
                                           double weight)
    : world_number(number), margin_m(margin) {
  weights.setConstant(static_cast<Eigen::Index>(robot.spheres.size()), weight);
}

void EdgeObstacleDistance::error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const {
  for (int i = 0; i < e.size(); ++i) {
    const double distance = world->now.distance(q.sphere_centres[i], q.time_s);
    e[i] = std::max(0.0, margin_m + q.robot->spheres[i].radius - distance);
  }
}

void EdgeObstacleDistance::jacobians(const ConfigurationState& q,
                                     JacobianRef<EdgeObstacleDistance, 0> j) const {
  for (int i = 0; i < j.rows(); ++i) {
    const CollisionSphere& sphere = q.robot->spheres[i];
    const DistanceSample sample = world->now.sample(q.sphere_centres[i], q.time_s);
    if (margin_m + sphere.radius - sample.distance <= 0.0) continue;
    q.kinematics.add_point_gradient(sphere.link, q.sphere_centres[i], sample.gradient, -1.0,
                                    j.row(i).data());
  }
}

}  // namespace locograph
