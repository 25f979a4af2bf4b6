#include <locograph/world/octree.h>
#include <locograph/world/world.h>

namespace locograph {

Surface ground() {
  Surface surface;
  surface.name = "ground";
  return surface;
}

World load_world(const std::filesystem::path& map, const std::filesystem::path& obstacles) {
  World world;
  if (!map.empty()) world.map = load_octree(map);
  if (!obstacles.empty()) world.obstacles = load_obstacles(obstacles);
  return world;
}

}  // namespace locograph
