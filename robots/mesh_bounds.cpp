#include <locograph/robots/collision_model.h>
#include <locograph/robots/mesh_file.h>

namespace locograph {

Eigen::AlignedBox3d mesh_bounds(const std::filesystem::path& file) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& corner : mesh_triangles(file)) bounds.extend(corner);
  return bounds;
}

}  // namespace locograph
