#include <locograph/common/error.h>
#include <locograph/world/link_solid.h>
#include <locograph/world/mesh_vertices.h>

#include <utility>
#include <vector>

namespace locograph {

ConvexShape link_solid(const Robot& robot, const CollisionShape& shape) {
  switch (shape.type) {
    case ShapeType::kSphere:
      return ConvexShape::sphere(shape.radius);
    case ShapeType::kCapsule:
      return ConvexShape::capsule(shape.radius, shape.length);
    case ShapeType::kCylinder:
      return ConvexShape::cylinder(shape.radius, shape.length);
    case ShapeType::kBox:
      return ConvexShape::box(shape.size);
    case ShapeType::kMesh:
      break;
  }
  if (!shape.mesh_found)
    throw Error(robot.urdf_file().string(), shape.line,
                "collision mesh " + shape.mesh_file.string() + " was not found",
                "a mesh file that can be read");
  std::vector<Eigen::Vector3d> vertices = mesh_vertices(shape.mesh_file);
  for (Eigen::Vector3d& vertex : vertices) vertex = vertex.cwiseProduct(shape.size).eval();
  return ConvexShape::hull(std::move(vertices));
}

}  // namespace locograph
