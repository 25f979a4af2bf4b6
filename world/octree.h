#pragma once
/// Reading, writing and building OctoMap occupancy trees.
///
///     std::shared_ptr<octomap::OcTree> map = locograph::load_octree("hall.bt");
///     locograph::OctreeInfo info = locograph::octree_info(*map);
///
///     std::vector<locograph::Box> boxes(1);
///     boxes[0].world_from_box.translation() = Eigen::Vector3d(1, 0, 0.5);
///     boxes[0].size = Eigen::Vector3d(0.4, 2, 1);
///     std::shared_ptr<octomap::OcTree> made = locograph::octree_from_boxes(boxes, 0.05);
///     locograph::save_octree(*made, "made.bt");
///
/// Lengths in metres, world frame. Files are OctoMap's own `.bt` (occupied/free/unknown) and `.ot`
/// (log-odds). A missing, empty or truncated file, one that is not an OctoMap file and a tree of
/// another type (ColorOcTree, ...) throw locograph::Error: the structure is walked before OctoMap's
/// reader, which does not notice the end of a file, sees a byte of it. The resolution is saved with
/// 17 digits. Nothing is printed.

#include <octomap/OcTree.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace locograph {

/// A solid box: centred at its frame's origin, size = extents along its axes [m].
struct Box {
  Eigen::Isometry3d world_from_box = Eigen::Isometry3d::Identity();
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
};

/// Reads `.bt` or `.ot`; the first line of the file, not its name, decides which.
std::shared_ptr<octomap::OcTree> load_octree(const std::filesystem::path& path);

/// Writes `.bt` through a temporary file in the same folder that is renamed at the end.
void save_octree(const octomap::OcTree& tree, const std::filesystem::path& path);

/// Occupied is every voxel whose centre lies inside (or on the surface of) a box; the rest stays
/// unknown. Boxes may be rotated. The tree is pruned. Throws Error on a resolution or an extent
/// that is not positive and finite, and on a box outside OctoMap's key range.
std::shared_ptr<octomap::OcTree> octree_from_boxes(std::span<const Box> boxes, double resolution_m);

/// Occupied is what either occupies, at the finer of their resolutions; voxels of the coarser one
/// grow to whole ones of the finer. Throws Error where that does not reach so far, and for more
/// than ten million such voxels.
std::shared_ptr<octomap::OcTree> joined(const octomap::OcTree& a, const octomap::OcTree& b);

struct OctreeInfo {
  double resolution_m = 0.0;
  std::size_t occupied_leaves = 0;  ///< leaves as stored: a pruned leaf of any size counts once
  std::size_t free_leaves = 0;
  /// Bounds of the occupied leaves' cubes; empty (isEmpty()) when nothing is occupied.
  Eigen::AlignedBox3d occupied_bounds;
  /// Bounds of all known leaves' cubes, occupied or free.
  Eigen::AlignedBox3d known_bounds;
};

OctreeInfo octree_info(const octomap::OcTree& tree);

}  // namespace locograph
