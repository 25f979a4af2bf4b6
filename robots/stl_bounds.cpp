#include <locograph/robots/collision_model.h>
#include <locograph/robots/stl_file.h>

namespace locograph {

Eigen::AlignedBox3d stl_bounds(const std::filesystem::path& file) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& corner : stl_triangles(file)) bounds.extend(corner);
  return bounds;
}

}  // namespace locograph
