#include <locograph/world/distance_view.h>
#include <locograph/world/octree.h>

#include <algorithm>
#include <cmath>

namespace locograph {

namespace {

/// Whether a field around all that is occupied is made in a second or two, and within OctoMap's
/// range.
bool is_small(const octomap::OcTree& map, double max_distance_m) {
  constexpr double kMostNodes = 4e6, kRange = 32000.0;
  const Eigen::AlignedBox3d bounds = octree_info(map).occupied_bounds;
  if (bounds.isEmpty()) return true;
  const double beyond = max_distance_m / map.getResolution() + 4.0;
  const Eigen::Vector3d lower = bounds.min() / map.getResolution(),
                        upper = bounds.max() / map.getResolution();
  return (upper - lower + Eigen::Vector3d::Constant(2.0 * beyond)).prod() <= kMostNodes &&
         std::max(-lower.minCoeff(), upper.maxCoeff()) + beyond <= kRange;
}

}  // namespace

double ground_height(const World& world) {
  constexpr double kLevel = 1e-9;
  double height = -std::numeric_limits<double>::infinity();
  for (const Surface& surface : world.surfaces) {
    if (!std::isinf(surface.half_x_m) || !std::isinf(surface.half_y_m)) continue;
    if (surface.world_from_surface.linear()(2, 2) > 1.0 - kLevel)
      height = std::max(height, surface.world_from_surface.translation().z());
  }
  return height;
}

WorldDistance distance_view(const World& world, DistanceFieldOptions options) {
  options.validate();
  options.ground_z = std::max(options.ground_z, ground_height(world));
  WorldDistance view;
  view.obstacles = world.obstacles;
  view.max_distance_without_map_m = options.max_distance_m;
  if (!world.map) return view;
  if (options.lower || is_small(*world.map, options.max_distance_m)) {
    view.map =
        std::make_shared<const DistanceField>(DistanceField::from_octree(*world.map, options));
  } else {
    view.leaves = std::make_shared<const VoxelTree>(*world.map);
    view.leaves_floor_z = options.ground_z;
  }
  return view;
}

}  // namespace locograph
