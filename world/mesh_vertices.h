#pragma once
/// The vertices of a mesh file (mesh_file.h), each once.
///
///     std::vector<Eigen::Vector3d> corners = locograph::mesh_vertices("thigh.stl");
///
/// Sorted by x, then y, then z. Throws Error as mesh_triangles().

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace locograph {

std::vector<Eigen::Vector3d> mesh_vertices(const std::filesystem::path& file);

}  // namespace locograph
