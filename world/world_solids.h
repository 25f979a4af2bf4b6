#pragma once
/// A world as judges see it: the exact solids of all that is in it. Made once for a world, read by
/// the CollisionWorld of every robot in it.
///
///     const auto solids = std::make_shared<const WorldSolids>(world);
///     CollisionWorld exact(robot, solids);
///
/// Throws Error for obstacles, surfaces, bars and boxes that cannot be used. Immutable.

#include <locograph/world/convex_shape.h>
#include <locograph/world/touchable_solids.h>
#include <locograph/world/voxel_tree.h>
#include <locograph/world/world.h>

#include <limits>
#include <optional>
#include <vector>

namespace locograph {

struct WorldSolids {
  std::optional<VoxelTree> voxels;
  std::vector<Obstacle> obstacles;
  std::vector<ConvexShape> obstacle_shapes;
  std::vector<PlateSolid> plates;
  std::vector<BarSolid> rods;
  std::vector<BoxSolid> blocks;
  double ground_z = -std::numeric_limits<double>::infinity();  ///< voxels up to here do not count

  explicit WorldSolids(const World& world);
};

}  // namespace locograph
