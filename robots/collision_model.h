#pragma once
/// Spheres that cover the collision shapes of a robot, for distance fields.
///
///     for (const locograph::CollisionSphere& sphere : locograph::covering_spheres(robot, 0.02)) {
///       Eigen::Vector3d centre = state.world_from_link(sphere.link) * sphere.center;
///     }
///
/// The union of the spheres contains every shape; those of a mesh (STL) are fitted to its triangles
/// (mesh_fit.h).
/// Spheres are sorted by link, then by shape.
///
/// CENTAURO takes 349, 211, 165, 116 and 96 spheres at an overshoot of 10, 15, 20, 25 and 30 mm, of
/// which each of the four flat-ended wheels takes 57, 26, 18, 8 and 4.

#include <locograph/robots/robot.h>

#include <Eigen/Core>
#include <vector>

namespace locograph {

struct CollisionSphere {
  int link = -1;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< m, link frame
  double radius = 0.0;                               ///< m
  int shape = -1;                                    ///< index into Robot::links()[link].collision
};

/// max_overshoot_m: no sphere reaches further than this out of its shape, unless that would take
/// more than max_spheres_per_shape spheres; then the overshoot grows until it does not.
/// Throws Error if a mesh was not found or is not a readable STL file, or an argument is not
/// positive.
std::vector<CollisionSphere> covering_spheres(const Robot& robot, double max_overshoot_m = 0.01,
                                              int max_spheres_per_shape = 64);

/// The same for one shape.
std::vector<CollisionSphere> covering_spheres(const CollisionShape& shape, double max_overshoot_m,
                                              int max_spheres_per_shape);

/// Corners of the axis-aligned bounding box of an STL file (text or binary), in the file's own
/// units. Throws Error if it cannot be read.
Eigen::AlignedBox3d mesh_bounds(const std::filesystem::path& file);

}  // namespace locograph
