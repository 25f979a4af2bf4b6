#pragma once
/// The vertices of an STL file (binary or text), each once.
///
///     std::vector<Eigen::Vector3d> corners = locograph::stl_vertices("thigh.stl");
///
/// In the file's own units, sorted by x, then y, then z. Throws Error if the file is missing,
/// truncated or not STL.

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace locograph {

std::vector<Eigen::Vector3d> stl_vertices(const std::filesystem::path& file);

}  // namespace locograph
