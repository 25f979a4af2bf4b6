#pragma once
/// The triangles of a mesh file: STL, COLLADA (.dae) or Wavefront OBJ, by how its name ends.
///
///     for (const MeshPart& part : mesh_parts("thigh.stl")) triangles += part.corners.size() / 3;
///     std::vector<Eigen::Vector3d> corners = mesh_triangles("thigh.stl");  // of all parts
///
/// Three corners for each triangle. STL and OBJ are in the file's own units; COLLADA is in metres,
/// by the unit that the file states. Its up axis is passed over, as in ROS: coordinates are those
/// of the file. A part has one material; STL has none. Files that a mesh refers to (.mtl) lie
/// beside it. Throws Error when the file cannot be read, is cut short, holds no triangle or is of
/// another kind.

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace locograph {

struct MeshPart {
  std::vector<Eigen::Vector3d> corners = {};
  std::optional<Eigen::Vector4d> color = std::nullopt;  ///< red, green, blue, alpha, 0 to 1
};

/// Whether the name ends as those of mesh files do.
bool is_mesh_file(const std::filesystem::path& file);

std::vector<MeshPart> mesh_parts(const std::filesystem::path& file);
std::vector<Eigen::Vector3d> mesh_triangles(const std::filesystem::path& file);

}  // namespace locograph
