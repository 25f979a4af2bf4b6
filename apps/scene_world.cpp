#include <locograph/apps/packed.h>
#include <locograph/apps/scene.h>
#include <locograph/apps/type_names.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace locograph {
namespace {

/// What a page can draw at 60 frames a second, and about 2 MB of it.
constexpr std::size_t kMostVoxels = 100000;

Json map_json(const octomap::OcTree& tree, const Eigen::AlignedBox3d& near) {
  struct Voxel {
    double squared_distance;
    std::array<float, 4> numbers;
  };
  std::vector<Voxel> voxels;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    const Eigen::Vector3d centre(leaf.getX(), leaf.getY(), leaf.getZ());
    voxels.push_back({near.squaredExteriorDistance(centre),
                      {static_cast<float>(centre.x()), static_cast<float>(centre.y()),
                       static_cast<float>(centre.z()), static_cast<float>(leaf.getSize())}});
  }
  const std::size_t left_out = voxels.size() - std::min(voxels.size(), kMostVoxels);
  if (left_out > 0) {
    std::stable_sort(voxels.begin(), voxels.end(), [](const Voxel& a, const Voxel& b) {
      return a.squared_distance < b.squared_distance;
    });
    voxels.resize(kMostVoxels);
    print_warning(counted(static_cast<long>(left_out), "voxel", "voxels") +
                  " far from the plan left out");
  }
  std::vector<float> numbers;
  for (const Voxel& voxel : voxels) {
    numbers.insert(numbers.end(), voxel.numbers.begin(), voxel.numbers.end());
  }
  return {{"resolution", tree.getResolution()},
          {"voxels", packed_floats(numbers)},
          {"left_out", left_out}};
}

Json obstacle_json(const Obstacle& obstacle) {
  Json json = {{"name", obstacle.name}, {"type", type_name(obstacle.shape)}};
  if (obstacle.shape == Obstacle::Shape::kBox) {
    json["size"] = vector_json(obstacle.size);
  } else if (obstacle.shape == Obstacle::Shape::kSphere) {
    json["size"] = {obstacle.size[0]};
  } else {
    json["size"] = {obstacle.size[0], obstacle.size[1]};
  }
  json["pose"] = pose_json(obstacle.world_from_obstacle);
  json["keyframes"] = Json::array();
  for (const KeyFrame& frame : obstacle.motion) {
    json["keyframes"].push_back({{"time", frame.time_s}, {"pose", pose_json(frame.pose)}});
  }
  json["repeat"] = obstacle.repeat_s;
  if (std::isfinite(obstacle.appears_s)) json["appears"] = obstacle.appears_s;
  if (std::isfinite(obstacle.vanishes_s)) json["vanishes"] = obstacle.vanishes_s;
  return json;
}

/// The unlimited ones are the ground, which every page has.
Json surfaces_json(const std::vector<Surface>& surfaces) {
  Json all = Json::array();
  for (const Surface& surface : surfaces) {
    if (!std::isfinite(surface.half_x_m) || !std::isfinite(surface.half_y_m)) continue;
    all.push_back({{"name", surface.name},
                   {"pose", pose_json(surface.world_from_surface)},
                   {"size", {rounded(2.0 * surface.half_x_m), rounded(2.0 * surface.half_y_m)}}});
  }
  return all;
}

Json bars_json(const std::vector<Bar>& bars) {
  Json all = Json::array();
  for (const Bar& bar : bars) {
    all.push_back({{"name", bar.name},
                   {"from", vector_json(bar.from)},
                   {"to", vector_json(bar.to)},
                   {"radius", rounded(bar.radius_m)}});
  }
  return all;
}

}  // namespace

void add_world_scene(const World& world, const Eigen::AlignedBox3d& near, Json& scene) {
  if (world.map) scene["map"] = map_json(*world.map, near);
  if (Json surfaces = surfaces_json(world.surfaces); !surfaces.empty()) {
    scene["surfaces"] = std::move(surfaces);
  }
  if (!world.bars.empty()) scene["bars"] = bars_json(world.bars);
  if (world.obstacles.empty()) return;
  scene["obstacles"] = Json::array();
  for (const Obstacle& obstacle : world.obstacles) {
    scene["obstacles"].push_back(obstacle_json(obstacle));
  }
}

}  // namespace locograph
