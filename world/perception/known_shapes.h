#pragma once
/// What of a world is known beforehand by its shape: surfaces, bars and solids. Cameras see them,
/// too, voxel by voxel; these voxels say nothing new, and are in the way of whoever stands there.
///
///     const std::vector<Eigen::Vector3i> voxels = voxels_of_shapes(world, window, 0.05);
///     map.clear(voxels);
///
/// A floor without an end is LocalMapOptions::floor_z_m instead.

#include <locograph/world/perception/voxel_window.h>
#include <locograph/world/world.h>

#include <Eigen/Core>
#include <vector>

namespace locograph {

/// Indices in the world of the window's voxels whose centres are inside of a shape or near it: at
/// most band_m away, or so near that a depth that is 2 cm wrong may end in them. Some may come
/// twice.
std::vector<Eigen::Vector3i> voxels_of_shapes(const World& world, const VoxelWindow& window,
                                              double band_m);

}  // namespace locograph
