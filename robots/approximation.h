#pragma once
/// How closely the spheres and capsules of the distance edges follow a robot's collision shapes,
/// measured at dense points that the covering did not look at.
///
///     const CapsuleOptions options{.max_overshoot_m = 0.01};
///     for (const LinkApproximation& link : approximations(robot, 0.02, options)) {
///       report(robot.links()[link.link].name, link.spheres.count, link.spheres.worst_over_m);
///     }

#include <locograph/robots/covering_capsules.h>

#include <span>
#include <string>
#include <vector>

namespace locograph {

struct Approximation {
  int count = 0;               ///< spheres or capsules
  double worst_over_m = 0.0;   ///< how far their union sticks out of the shape
  double worst_under_m = 0.0;  ///< how far the shape's surface sticks out of their union
};

/// cover: in the frame of the shape's link. A mesh is the solid its triangles enclose. Throws Error
/// as collision_mesh().
Approximation measured(const CollisionShape& shape, std::span<const Capsule> cover);

/// Of all shapes of one link: sums of counts, the worst of the rest, each shape against its own
/// cover.
struct LinkApproximation {
  int link = -1;
  int shapes = 0;
  Approximation spheres;   ///< covering_spheres(): what obstacles are kept away from
  Approximation capsules;  ///< covering_capsules(): what links are kept apart by
  std::string unusable;    ///< why a mesh of this link could not be read; the rest is 0 then
};

/// One for each link with collision shapes, in the order of Robot::links().
std::vector<LinkApproximation> approximations(const Robot& robot, double sphere_overshoot_m,
                                              const CapsuleOptions& options);

}  // namespace locograph
