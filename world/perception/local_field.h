#pragma once
/// The distance to what a LocalMap took for occupied at one time: an immutable snapshot, stamped.
///
///     std::shared_ptr<const LocalField> field = map.field();
///     DistanceSample s = field->sample(point);
///     if (!field->is_known(point)) slow_down();
///
/// A snapshot of a world for planners:
///
///     World world;                               // obstacles known otherwise; no map
///     WorldDistance seen;
///     seen.source = field;
///     const auto snapshot =
///         std::make_shared<const WorldSnapshot>(std::move(world), std::move(seen),
///         field->stamp_s());
///
/// Squared distances between voxel centres are exact up to the maximum. Between centres values and
/// gradients are those of DistanceField: trilinear, and below the distance to the occupied cubes by
/// the same amount, so that a field of the same voxels from an OctoMap reads the same bits where
/// space is free. Inside of obstacles the depth is not measured: it reads at most 1.12 voxels.
///
/// Outside of the window there are no obstacles, with UnknownSpace::kOccupied nothing else.
///
/// All const members are thread-safe and do not allocate.

#include <locograph/world/distance_source.h>
#include <locograph/world/perception/local_map_options.h>
#include <locograph/world/perception/voxel_window.h>
#include <octomap/OcTree.h>

#include <cstdint>
#include <span>
#include <vector>

namespace locograph {

class LocalField final : public DistanceSource {
 public:
  DistanceSample sample(const Eigen::Vector3d& point) const override;
  double distance(const Eigen::Vector3d& point) const { return sample(point).distance; }
  double max_distance() const override { return max_distance_m_; }
  /// Whether the voxel at the point has been seen; not outside of the window.
  bool is_known(const Eigen::Vector3d& point) const override;

  /// That of the newest image in it; minus infinity when there is none.
  double stamp_s() const { return stamp_s_; }
  const VoxelWindow& window() const { return window_; }

  /// Of a voxel inside of the window, by its world indices.
  bool is_occupied(const Eigen::Vector3i& index) const {
    return log_odds_[window_.stored(index)] >= scale_.occupied_from;
  }
  bool is_known(const Eigen::Vector3i& index) const {
    return log_odds_[window_.stored(index)] != kNeverSeen;
  }
  /// [voxels^2] from centre to centre of the nearest obstacle. Farther than the field knows: the
  /// square of LocalMapOptions::cap() and one more.
  int squared_distance(const Eigen::Vector3i& index) const {
    return squared_[window_.stored(index)];
  }

  /// As LocalMap::merge_into(), while the map goes on in another thread.
  void merge_into(octomap::OcTree& tree) const;

 private:
  friend class LocalMap;
  friend class FieldBuffers;

  DistanceSample sample_inside(const Eigen::Vector3d& point) const;

  VoxelWindow window_;
  LogOdds scale_;
  UnknownSpace unknown_ = UnknownSpace::kFree;
  double max_distance_m_ = 0.0, inverse_resolution_ = 0.0;
  double stamp_s_ = 0.0;
  Eigen::Vector3d lowest_node_, highest_node_;
  std::vector<std::int8_t> log_odds_;
  std::vector<std::int16_t> squared_;
  std::vector<float> value_of_squared_;  // [m]
};

}  // namespace locograph
