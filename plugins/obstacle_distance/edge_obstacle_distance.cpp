#include <locograph/plugins/obstacle_distance/edge_obstacle_distance.h>

namespace locograph {

template class TypedEdgePool<EdgeObstacleDistance>;

EdgeObstacleDistance::EdgeObstacleDistance(const RobotParameter& robot, int number, double margin,
                                           double weight)
    : world_number(number), margin_m(margin) {
  weights.setConstant(static_cast<Eigen::Index>(robot.spheres.size()), weight);
}

namespace {

/// Calls f for every sphere of the links that are not wholly out of reach.
template <class F>
void each_near_sphere(const ConfigurationState& q, const WorldDistance& world, double margin_m,
                      F&& f) {
  for (std::size_t link = 0; link < q.robot->bounds.size(); ++link) {
    const RobotParameter::LinkBound& bound = q.robot->bounds[link];
    // The field changes by no more than the way, so nothing inside the bound can be nearer.
    const double reach = bound.radius + margin_m;
    if (reach < world.max_distance() && world.distance(q.bound_centre(link), q.time_s) > reach)
      continue;
    for (int i = bound.begin; i < bound.end; ++i) f(i);
  }
}

}  // namespace

void EdgeObstacleDistance::error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e,
                                 const Bindings& bindings) const {
  require_rows(kTag, e.size(), static_cast<long>(q.robot->spheres.size()));
  e.setZero();
  const WorldDistance& seen = bindings.get(world_number, *world).snapshot->distance();
  each_near_sphere(q, seen, margin_m, [&](int i) {
    const double distance = seen.distance(q.sphere_centres[i], q.time_s);
    e[i] = std::max(0.0, margin_m + q.robot->spheres[i].radius - distance);
  });
}

void EdgeObstacleDistance::jacobians(const ConfigurationState& q,
                                     JacobianRef<EdgeObstacleDistance, 0> j,
                                     const Bindings& bindings) const {
  const WorldDistance& seen = bindings.get(world_number, *world).snapshot->distance();
  each_near_sphere(q, seen, margin_m, [&](int i) {
    const CollisionSphere& sphere = q.robot->spheres[i];
    const DistanceSample sample = seen.sample(q.sphere_centres[i], q.time_s);
    if (margin_m + sphere.radius - sample.distance <= 0.0) return;
    q.kinematics.add_point_gradient(sphere.link, q.sphere_centres[i], sample.gradient, -1.0,
                                    j.row(i).data());
  });
}

}  // namespace locograph
