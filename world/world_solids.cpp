#include <locograph/world/box_tree.h>
#include <locograph/world/distance_view.h>
#include <locograph/world/world_solids.h>

namespace locograph {
namespace {

ConvexShape obstacle_solid(const Obstacle& obstacle) {
  switch (obstacle.shape) {
    case Obstacle::Shape::kSphere:
      return ConvexShape::sphere(obstacle.size[0]);
    case Obstacle::Shape::kCylinder:
      return ConvexShape::cylinder(obstacle.size[0], obstacle.size[1]);
    case Obstacle::Shape::kBox:
      break;
  }
  return ConvexShape::box(obstacle.size);
}

}  // namespace

WorldSolids::WorldSolids(const World& world)
    : obstacles(world.obstacles), ground_z(ground_height(world)) {
  if (world.map) voxels.emplace(*world.map);
  for (const Obstacle& obstacle : obstacles) {
    obstacle.validate();
    obstacle_shapes.push_back(obstacle_solid(obstacle));
  }
  for (const SolidBox& box : world.solids) blocks.emplace_back(box);
  for (const Surface& surface : world.surfaces) plates.emplace_back(surface);
  const std::vector<int> solids = solids_of_surfaces(world);
  for (std::size_t p = 0; p < solids.size(); ++p) plates[p].block = solids[p];
  for (const Bar& bar : world.bars) rods.emplace_back(bar);
}

}  // namespace locograph
