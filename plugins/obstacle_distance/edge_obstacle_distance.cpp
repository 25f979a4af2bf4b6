#include <locograph/plugins/configuration/near_spheres.h>
#include <locograph/plugins/obstacle_distance/edge_obstacle_distance.h>

namespace locograph {

template class TypedEdgePool<EdgeObstacleDistance>;

EdgeObstacleDistance::EdgeObstacleDistance(const RobotParameter& robot, int number, double margin,
                                           double weight)
    : world_number(number), margin_m(margin) {
  weights.setConstant(static_cast<Eigen::Index>(robot.spheres.size()), weight);
}

void EdgeObstacleDistance::error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e,
                                 const Bindings& bindings) const {
  require_rows(kTag, e.size(), static_cast<long>(q.robot->spheres.size()));
  e.setZero();
  const WorldDistance& seen = bindings.get(world_number, *world).snapshot->distance();
  each_near_sphere(*q.robot, {q.bound_centres, q.sphere_centres}, seen, q.time_s, margin_m,
                   [&](int i, double distance) {
                     e[i] = std::max(0.0, margin_m + q.robot->spheres[i].radius - distance);
                   });
}

void EdgeObstacleDistance::jacobians(const ConfigurationState& q,
                                     JacobianRef<EdgeObstacleDistance, 0> j,
                                     const Bindings& bindings) const {
  const WorldDistance& seen = bindings.get(world_number, *world).snapshot->distance();
  each_near_sphere(*q.robot, {q.bound_centres, q.sphere_centres}, seen, q.time_s, margin_m,
                   [&](int i, double distance) {
                     const CollisionSphere& sphere = q.robot->spheres[i];
                     if (margin_m + sphere.radius - distance <= 0.0) return;
                     const Eigen::Vector3d centre = q.sphere_centre(i);
                     q.kinematics.add_point_gradient(sphere.link, centre,
                                                     seen.sample(centre, q.time_s).gradient, -1.0,
                                                     j.row(i).data());
                   });
}

}  // namespace locograph
