#pragma once
/// A window of voxels around the robot that depth images fill: what is near, known as it is now.
///
///     LocalMap map(LocalMapOptions{.floor_z_m = 0.0});
///     map.move_to(robot_at);
///     map.insert(camera, world_from_optical, image);
///     std::shared_ptr<const LocalField> field = map.field();   // for planners, in any thread
///
/// Each pixel hits the voxel that it ends in; each voxel that an image looks through is missed.
/// So a voxel is looked at once an image, however many rays cross it, and yet a thin pole or the
/// floor at a grazing angle is not lost (doc/perception.md). Log-odds with tight clamps: what
/// leaves is gone after three images.
///
/// The window is a ring along each axis: a move forgets what it leaves and touches only what
/// enters, which was never seen. No member but the constructor, load(), and merge_into() allocates
/// once images of all sizes and three fields have been seen, unless readers hold more than two
/// fields.
///
/// One thread at a time; fields may be read in others meanwhile. Bad input throws Error and changes
/// nothing.

#include <locograph/world/perception/depth_camera.h>
#include <locograph/world/perception/depth_image.h>
#include <locograph/world/perception/field_buffers.h>
#include <locograph/world/perception/local_field.h>
#include <locograph/world/perception/local_map_options.h>
#include <locograph/world/perception/window_transform.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace locograph {

class LocalMap {
 public:
  /// simd_level: of the kernels (common/simd_level.h); empty: that of the process. The results are
  /// the same bits.
  explicit LocalMap(const LocalMapOptions& options = {}, const std::string& simd_level = "");

  /// The window follows when its centre is more than 8 voxels away along an axis, in steps of 8.
  void move_to(const Eigen::Vector3d& centre);
  /// The image's pixels are the camera's; those that show the robot are 0. A newer image may be
  /// followed by an older one.
  void insert(const DepthCamera& camera, const Eigen::Isometry3d& world_from_optical,
              const DepthImage& image);
  /// Voxels whose centres are in the box are free, known by other means: the robot stands there.
  void clear(const Eigen::AlignedBox3d& box);
  /// Of these voxels, by their indices in the world, those that are occupied are free: what is
  /// there is known by other means. Those outside of the window do not count.
  void clear(std::span<const Eigen::Vector3i> voxels);

  /// The newest; the same one until something changes.
  std::shared_ptr<const LocalField> field();

  /// Fills what was never seen from an OctoMap. It may have another resolution: a voxel is occupied
  /// if an occupied leaf overlaps it, otherwise free if its centre is in a free leaf. Like
  /// merge_into() not for the cycle: it takes tens of milliseconds and allocates.
  void load(const octomap::OcTree& tree);
  /// Puts all that was seen in the place of what the tree knows there; LocalField::merge_into()
  /// does the same in another thread. Throws Error for a tree of another resolution.
  void merge_into(octomap::OcTree& tree) const;

  const LocalMapOptions& options() const { return options_; }
  const VoxelWindow& window() const { return window_; }
  /// That of the newest image; minus infinity before the first.
  double stamp_s() const { return stamp_s_; }
  /// Of a voxel inside of the window, by its world indices; kNeverSeen if it never was.
  int log_odds(const Eigen::Vector3i& index) const { return log_odds_[window_.stored(index)]; }
  /// Of everything that belongs to it, fields that others hold included.
  std::size_t memory_bytes() const;

 private:
  LocalField blank_field() const;
  void fit_image(const DepthCamera& camera);
  void forget_until(double stamp_s);
  void add_hits(const DepthCamera& camera, int touched);
  void set_log_odds(std::size_t stored, std::int8_t value);
  void forget_all_but(const Eigen::Vector3i& lowest);

  LocalMapOptions options_;
  const WindowKernels& kernels_;
  VoxelWindow window_;
  ObstacleRange obstacle_;
  AlignedVector<std::int8_t> log_odds_;
  AlignedVector<std::uint8_t> hits_, age_;  // age_: empty if nothing is forgotten
  double stamp_s_;
  WindowTransform transform_;
  FieldBuffers buffers_;
  std::shared_ptr<const LocalField> field_;  // the newest, unless stale_
  bool stale_ = true;

  // Of one image.
  PooledImage pooled_{};
  AlignedVector<std::uint16_t> block_, row_;
  AlignedVector<std::int32_t> nearest_, code_, run_, free_;
  AlignedVector<float> column_, from_, to_;
  std::vector<TouchedVoxel> touched_;
};

}  // namespace locograph
