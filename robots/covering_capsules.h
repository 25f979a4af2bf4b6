#pragma once
/// Capsules that cover the collision shapes of a robot, for distances between its links.
///
///     for (const CollisionCapsule& c : covering_capsules(robot, {.max_overshoot_m = 0.01})) {
///       Eigen::Vector3d from = state.world_from_link(c.link) * c.capsule.from;
///     }
///
/// A capsule or a sphere of the URDF is itself. Boxes and cylinders become spheres (see
/// collision_model.h), meshes capsules fitted to their triangles (mesh_fit.h). The union contains
/// every shape. Sorted by link, then by shape.

#include <locograph/robots/capsule.h>
#include <locograph/robots/robot.h>
#include <locograph/robots/triangle_tree.h>

#include <vector>

namespace locograph {

struct CollisionCapsule {
  int link = -1;
  Capsule capsule;  ///< link frame
  int shape = -1;   ///< index into Robot::links()[link].collision
};

struct CapsuleOptions {
  /// No capsule reaches further than this out of its shape, unless that would take more of them
  /// than the limits below; approximation.h measures what it came to.
  double max_overshoot_m = 0.01;
  int max_spheres_per_shape = 64;  ///< of a box or a cylinder
  int max_capsules_per_mesh = 12;
};

/// Throws Error if a mesh was not found or is not a readable STL file, or an option is not
/// positive.
std::vector<CollisionCapsule> covering_capsules(const Robot& robot,
                                                const CapsuleOptions& options = {});

/// The same for one shape, in the frame of its link.
std::vector<Capsule> covering_capsules(const CollisionShape& shape,
                                       const CapsuleOptions& options = {});

/// The triangles of a mesh in the frame of the shape, scaled as the URDF says [m]. Throws Error if
/// the shape's mesh was not found or is not a readable STL file.
TriangleTree collision_mesh(const CollisionShape& shape);

/// The same capsule seen from another frame.
Capsule transformed(const Eigen::Isometry3d& frame_from_capsule, const Capsule& capsule);

}  // namespace locograph
