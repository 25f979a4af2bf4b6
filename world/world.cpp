#include <locograph/world/octree.h>
#include <locograph/world/world.h>

#include <cmath>

namespace locograph {

Surface ground() {
  Surface surface;
  surface.name = "ground";
  return surface;
}

bool is_part_of(const SolidBox& box, const Surface& surface) {
  if (std::isinf(surface.half_x_m) || std::isinf(surface.half_y_m)) return false;
  const Eigen::Isometry3d box_from_surface =
      box.world_from_box.inverse() * surface.world_from_surface;
  const double rounding = 1e-9 * (1.0 + box.size_m.maxCoeff());
  for (const double x : {surface.half_x_m, -surface.half_x_m}) {
    for (const double y : {surface.half_y_m, -surface.half_y_m}) {
      const Eigen::Vector3d corner = box_from_surface * Eigen::Vector3d(x, y, 0.0);
      if ((corner.cwiseAbs() - 0.5 * box.size_m).maxCoeff() > rounding) return false;
    }
  }
  return true;
}

World load_world(const std::filesystem::path& map, const std::filesystem::path& obstacles) {
  World world;
  if (!map.empty()) world.map = load_octree(map);
  if (!obstacles.empty()) world.obstacles = load_obstacles(obstacles);
  return world;
}

}  // namespace locograph
