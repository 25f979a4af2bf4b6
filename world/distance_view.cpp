#include <locograph/world/distance_view.h>

#include <algorithm>
#include <cmath>

namespace locograph {

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
  if (world.map)
    view.map =
        std::make_shared<const DistanceField>(DistanceField::from_octree(*world.map, options));
  return view;
}

}  // namespace locograph
