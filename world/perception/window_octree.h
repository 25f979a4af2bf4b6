#pragma once
/// A window of voxels from an OctoMap, and back into one. Internal: see LocalMap.

#include <locograph/world/perception/local_map_options.h>
#include <locograph/world/perception/voxel_window.h>
#include <octomap/OcTree.h>

#include <cstdint>
#include <span>

namespace locograph {

/// Log-odds of what was never seen, from the tree. Anything below floor_top_m is free.
void fill_unseen(const octomap::OcTree& tree, const VoxelWindow& window, const LogOdds& scale,
                 double floor_top_m, std::span<std::int8_t> log_odds);

/// Throws Error, before anything is changed, when the tree's resolution is another one.
void merge_window(const VoxelWindow& window, const LogOdds& scale,
                  std::span<const std::int8_t> log_odds, octomap::OcTree& tree);

}  // namespace locograph
