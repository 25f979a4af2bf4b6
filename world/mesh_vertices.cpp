#include <locograph/robots/mesh_file.h>
#include <locograph/world/mesh_vertices.h>

#include <algorithm>

namespace locograph {

std::vector<Eigen::Vector3d> mesh_vertices(const std::filesystem::path& file) {
  std::vector<Eigen::Vector3d> corners = mesh_triangles(file);
  const auto less = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::sort(corners.begin(), corners.end(), less);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

}  // namespace locograph
