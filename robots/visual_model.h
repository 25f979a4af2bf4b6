#pragma once
/// What a robot looks like: the visual shapes of its URDF with their colours, for viewers.
///
///     for (const locograph::VisualShape& shape : locograph::load_visuals(robot)) {
///       Eigen::Isometry3d world_from_shape =
///           state.world_from_link(shape.link) * shape.link_from_shape;
///       if (shape.type == locograph::ShapeType::kSphere) {
///         draw_sphere(world_from_shape, shape.radius);
///       }
///     }
///
/// Meshes are drawable when their file exists and is one that mesh_file.h reads; of the others the
/// URDF's reference is kept, so that missing_meshes() can name them. A link with a mesh that is not
/// drawable gets stand-ins: its collision shapes or, where it has none that can be drawn, a thin
/// capsule from its origin to each joint below it.
///
/// Colours are those of the materials, named or inline, defined in the visual, in another one or
/// at the robot; without any, those of the mesh's own materials; a texture, or none of these, is
/// light grey.

#include <locograph/robots/robot.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <vector>

namespace locograph {

/// Fields as in CollisionShape.
struct VisualShape {
  int link = -1;
  ShapeType type = ShapeType::kSphere;
  Eigen::Isometry3d link_from_shape = Eigen::Isometry3d::Identity();
  double radius = 0.0;                              ///< m
  double length = 0.0;                              ///< m
  Eigen::Vector3d size = Eigen::Vector3d::Ones();   ///< box: extents [m]; mesh: scale
  Eigen::Vector4d color = Eigen::Vector4d::Ones();  ///< red, green, blue, alpha, 0 to 1
  std::filesystem::path mesh_file;  ///< resolved path, or as written in the URDF if not found
  bool mesh_found = false;          ///< the file exists and can be read
  int mesh_part = -1;               ///< of mesh_parts(); -1: all of them
  bool has_color = false;           ///< by the URDF

  bool drawable() const { return type != ShapeType::kMesh || mesh_found; }
};

/// Sorted by link. Throws Error with file and line for a URDF that changed since the robot was
/// loaded and is unusable now, and for colours that are none.
std::vector<VisualShape> load_visuals(const Robot& robot);

/// References of the meshes that cannot be drawn, sorted, each once.
std::vector<std::string> missing_meshes(const std::vector<VisualShape>& shapes);

/// Height of the lowest point of a shape in the world [m]. Reads the file of a mesh.
double lowest_point(const VisualShape& shape, const Eigen::Isometry3d& world_from_link);

/// Height of the lowest point of the robot's collision shapes in configuration q; where none is
/// drawable of its visual shapes; where there is none of these either, of its link origins [m].
double lowest_point(const Robot& robot, const Eigen::VectorXd& q);

/// A collision shape as it would be drawn.
VisualShape as_visual(const CollisionShape& shape, const Eigen::Vector4d& color);

/// Pose of a capsule or cylinder whose axis goes from one point to another.
Eigen::Isometry3d pose_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace locograph
