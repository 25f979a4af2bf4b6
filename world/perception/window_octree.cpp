#include <locograph/common/error.h>
#include <locograph/world/perception/window_octree.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace locograph {
namespace {

constexpr int kKeysBelow0 = 1 << 15;  // of OctoMap: key = index + 2^15
constexpr double kSliver = 1e-6;      // voxels; less than this of an overlap is rounding

/// OctoMap's log-odds and ours: least, the border between free and occupied, and most stand for
/// each other, straight lines between them.
struct ScaleOfTree {
  float least, border, most;
  LogOdds ours;

  ScaleOfTree(const octomap::OcTree& tree, const LogOdds& scale)
      : border(tree.getOccupancyThresLog()), ours(scale) {
    least = std::min(tree.getClampingThresMinLog(), border - 1e-3f);
    most = std::max(tree.getClampingThresMaxLog(), border + 1e-3f);
  }

  std::int8_t to_ours(float value) const {
    if (value >= border) {
      const float share = std::min(1.0f, (value - border) / (most - border));
      const auto steps = static_cast<float>(ours.most - ours.occupied_from);
      return static_cast<std::int8_t>(ours.occupied_from + std::lround(share * steps));
    }
    const float share = std::min(1.0f, (border - value) / (border - least));
    const auto steps = static_cast<float>(ours.occupied_from - ours.least);
    return static_cast<std::int8_t>(ours.occupied_from - std::max(1L, std::lround(share * steps)));
  }

  float to_tree(std::int8_t value) const {
    if (value >= ours.occupied_from) {
      const auto steps = static_cast<float>(std::max(1, ours.most - ours.occupied_from));
      return border + (most - border) * static_cast<float>(value - ours.occupied_from) / steps;
    }
    const auto steps = static_cast<float>(ours.occupied_from - ours.least);
    return border - (border - least) * static_cast<float>(ours.occupied_from - value) / steps;
  }
};

struct VoxelRange {
  Eigen::Vector3i first, last;
};

template <class Visit>
void for_each_voxel(const VoxelRange& range, Visit visit) {
  for (int k = range.first[2]; k <= range.last[2]; ++k)
    for (int j = range.first[1]; j <= range.last[1]; ++j)
      for (int i = range.first[0]; i <= range.last[0]; ++i) visit(Eigen::Vector3i(i, j, k));
}

}  // namespace

void fill_unseen(const octomap::OcTree& tree, const VoxelWindow& window, const LogOdds& scale,
                 double floor_top_m, std::span<std::int8_t> log_odds) {
  const ScaleOfTree scales(tree, scale);
  const double h = window.resolution_m;
  const Eigen::Vector3i last = window.first + window.size - Eigen::Vector3i::Ones();
  const double scale_of_leaf = tree.getResolution() / h;  // voxels of the window
  // Keys are clamped: leaves that do not overlap the window are clipped to nothing.
  const auto key = [&](const Eigen::Vector3d& at) {
    octomap::OcTreeKey found;
    for (int axis = 0; axis < 3; ++axis) {
      const double index = std::floor(at[axis] / tree.getResolution()) + kKeysBelow0;
      found[static_cast<unsigned>(axis)] =
          static_cast<octomap::key_type>(std::clamp(index, 0.0, 65535.0));
    }
    return found;
  };
  const octomap::OcTreeKey low = key(window.bounds().min()), high = key(window.bounds().max());
  std::vector<std::uint8_t> was_seen(log_odds.size());
  std::ranges::transform(log_odds, was_seen.begin(),
                         [](std::int8_t value) { return value != kNeverSeen ? 1 : 0; });
  const double floor_top = floor_top_m / h;
  // Of the leaves that share a voxel the most occupied one counts.
  const auto put = [&](const Eigen::Vector3i& index, std::int8_t value) {
    const std::size_t at = window.stored(index);
    if (was_seen[at]) return;
    if (index[2] + 1 <= floor_top + kSliver)
      value = std::min(value, static_cast<std::int8_t>(scale.occupied_from - 1));
    log_odds[at] = std::max(log_odds[at], value);
  };
  const auto clipped = [&](const Eigen::Array3d& first, const Eigen::Array3d& beyond) {
    VoxelRange range{window.first, last};
    for (int axis = 0; axis < 3; ++axis) {
      range.first[axis] =
          static_cast<int>(std::clamp<double>(first[axis], window.first[axis], last[axis] + 1));
      range.last[axis] =
          static_cast<int>(std::clamp<double>(beyond[axis], window.first[axis], last[axis] + 1)) -
          1;
    }
    return range;
  };
  for (octomap::OcTree::leaf_bbx_iterator leaf = tree.begin_leafs_bbx(low, high);
       leaf != tree.end_leafs_bbx(); ++leaf) {
    const int extent = 1 << (tree.getTreeDepth() - leaf.getDepth());
    Eigen::Array3d lower;
    for (unsigned axis = 0; axis < 3; ++axis)
      lower[axis] = ((leaf.getKey()[axis] & ~(extent - 1)) - kKeysBelow0) * scale_of_leaf;
    const Eigen::Array3d upper = lower + extent * scale_of_leaf;
    const std::int8_t value = scales.to_ours(leaf->getLogOdds());
    // Occupied: every voxel that it overlaps; free: those whose centre lies in it.
    Eigen::Array3d first = (lower + kSliver).floor(), beyond = (upper - kSliver).ceil();
    if (value < scale.occupied_from) {
      first = (lower - 0.5 - kSliver).ceil();
      beyond = (upper - 0.5 - kSliver).ceil();
    }
    for_each_voxel(clipped(first, beyond),
                   [&](const Eigen::Vector3i& index) { put(index, value); });
  }
}

void merge_window(const VoxelWindow& window, const LogOdds& scale,
                  std::span<const std::int8_t> log_odds, octomap::OcTree& tree) {
  const double h = window.resolution_m;
  if (std::abs(tree.getResolution() - h) > 1e-9 * h) {
    throw Error("the OctoMap's voxels are of " + std::to_string(tree.getResolution()) + " m",
                "those of the local map, " + std::to_string(h) + " m");
  }
  const ScaleOfTree scales(tree, scale);
  const VoxelRange all{
      window.first.cwiseMax(-kKeysBelow0),
      (window.first + window.size - Eigen::Vector3i::Ones()).cwiseMin(kKeysBelow0 - 1)};
  for_each_voxel(all, [&](const Eigen::Vector3i& index) {
    const std::int8_t value = log_odds[window.stored(index)];
    if (value == kNeverSeen) return;
    const octomap::OcTreeKey key(static_cast<octomap::key_type>(index[0] + kKeysBelow0),
                                 static_cast<octomap::key_type>(index[1] + kKeysBelow0),
                                 static_cast<octomap::key_type>(index[2] + kKeysBelow0));
    tree.setNodeValue(key, scales.to_tree(value), true);
  });
  tree.updateInnerOccupancy();
  tree.prune();
}

}  // namespace locograph
