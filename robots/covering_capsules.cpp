#include <locograph/common/error.h>
#include <locograph/robots/collision_model.h>
#include <locograph/robots/covering_capsules.h>
#include <locograph/robots/mesh_file.h>
#include <locograph/robots/mesh_fit.h>
#include <locograph/robots/shape_covers.h>

namespace locograph {

Capsule transformed(const Eigen::Isometry3d& frame_from_capsule, const Capsule& capsule) {
  return {frame_from_capsule * capsule.from, frame_from_capsule * capsule.to, capsule.radius};
}

TriangleTree collision_mesh(const CollisionShape& shape) {
  if (!shape.mesh_found) {
    throw Error(shape.mesh_file.string(), 0, "collision mesh not found",
                "a file below a folder above the URDF");
  }
  std::vector<Eigen::Vector3d> corners = mesh_triangles(shape.mesh_file);
  for (Eigen::Vector3d& corner : corners) corner.array() *= shape.size.array();
  return TriangleTree(std::move(corners));
}

std::vector<Capsule> covering_capsules(const CollisionShape& shape, const CapsuleOptions& options) {
  if (!(options.max_overshoot_m > 0.0) || options.max_spheres_per_shape < 1 ||
      options.max_capsules_per_mesh < 1) {
    throw Error("covering capsules with overshoot " + std::to_string(options.max_overshoot_m) +
                    " m, " + std::to_string(options.max_spheres_per_shape) +
                    " spheres per shape and " + std::to_string(options.max_capsules_per_mesh) +
                    " capsules per mesh",
                "positive numbers");
  }
  std::vector<Capsule> capsules;
  switch (shape.type) {
    case ShapeType::kSphere:
    case ShapeType::kCapsule: {
      const double half = shape.type == ShapeType::kCapsule ? 0.5 * shape.length : 0.0;
      const Eigen::Vector3d along = half * shape.link_from_shape.linear().col(2);
      const Eigen::Vector3d middle = shape.link_from_shape.translation();
      return {{middle - along, middle + along, shape.radius}};
    }
    case ShapeType::kCylinder:
    case ShapeType::kBox:
      for (const CollisionSphere& sphere :
           covering_spheres(shape, options.max_overshoot_m, options.max_spheres_per_shape)) {
        capsules.push_back({sphere.center, sphere.center, sphere.radius});
      }
      return capsules;
    case ShapeType::kMesh:
      break;
  }
  capsules = fit_capsules(collision_mesh(shape),
                          {options.max_overshoot_m, options.max_capsules_per_mesh, false});
  for (Capsule& capsule : capsules) capsule = transformed(shape.link_from_shape, capsule);
  return capsules;
}

std::vector<CollisionCapsule> covering_capsules(const Robot& robot, const CapsuleOptions& options) {
  ShapeCovers<std::vector<Capsule>> covers(
      [&](const CollisionShape& shape) { return covering_capsules(shape, options); });
  std::vector<CollisionCapsule> result;
  for (const Link& link : robot.links()) {
    for (std::size_t s = 0; s < link.collision.size(); ++s) {
      const CollisionShape& shape = link.collision[s];
      for (const Capsule& capsule : covers.of(robot, shape)) {
        result.push_back(
            {shape.link, transformed(shape.link_from_shape, capsule), static_cast<int>(s)});
      }
    }
  }
  return result;
}

}  // namespace locograph
