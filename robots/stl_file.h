#pragma once
/// The triangles of an STL file, text or binary.
///
///     std::vector<Eigen::Vector3d> corners = locograph::stl_triangles("thigh.stl");
///     for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
///       area += 0.5 * (corners[i + 1] - corners[i]).cross(corners[i + 2] - corners[i]).norm();
///     }
///
/// Three corners for each triangle, in the file's order and own units. Throws Error when the file
/// cannot be read, is cut short or holds no triangle.

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace locograph {

std::vector<Eigen::Vector3d> stl_triangles(const std::filesystem::path& file);

}  // namespace locograph
