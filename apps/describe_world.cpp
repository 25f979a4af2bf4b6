#include <locograph/apps/describe.h>
#include <locograph/apps/type_names.h>
#include <locograph/world/octree.h>

#include <cmath>

namespace locograph {
namespace {

Json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json bounds_json(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return nullptr;
  return {{"lower_m", vector_json(box.min())}, {"upper_m", vector_json(box.max())}};
}

Json size_json(const Obstacle& obstacle) {
  switch (obstacle.shape) {
    case Obstacle::Shape::kBox:
      return {{"extents_m", vector_json(obstacle.size)}};
    case Obstacle::Shape::kSphere:
      return {{"radius_m", obstacle.size[0]}};
    case Obstacle::Shape::kCylinder:
      return {{"radius_m", obstacle.size[0]}, {"height_m", obstacle.size[1]}};
  }
  return nullptr;
}

}  // namespace

Json describe_map(const std::filesystem::path& path) {
  const OctreeInfo info = octree_info(*load_octree(path));
  return {{"file", path.string()},
          {"kind", "map"},
          {"resolution_m", info.resolution_m},
          {"occupied_leaves", info.occupied_leaves},
          {"free_leaves", info.free_leaves},
          {"occupied_bounds", bounds_json(info.occupied_bounds)},
          {"known_bounds", bounds_json(info.known_bounds)}};
}

Json describe_obstacles(const std::filesystem::path& path) {
  Json obstacles = Json::array();
  for (const Obstacle& obstacle : load_obstacles(path)) {
    Json json = {{"shape", type_name(obstacle.shape)}, {"name", obstacle.name}};
    json["center_m"] = vector_json(obstacle.world_from_obstacle.translation());
    json.update(size_json(obstacle));
    json["key_frames"] = obstacle.motion.size();
    if (std::isfinite(obstacle.appears_s)) json["appears_s"] = obstacle.appears_s;
    if (std::isfinite(obstacle.vanishes_s)) json["vanishes_s"] = obstacle.vanishes_s;
    obstacles.push_back(json);
  }
  return {{"file", path.string()},
          {"kind", "obstacles"},
          {"count", obstacles.size()},
          {"obstacles", obstacles}};
}

}  // namespace locograph
