#pragma once
/// Exact squared Euclidean distances from all voxels of a window to the nearest occupied one, up to
/// a cap: along z, then with y, then with x. Internal: LocalMap keeps one up to date.
///
///     const ObstacleRange obstacles{.first = 20, .span = 107};
///     WindowTransform transform(window, 22, obstacles, false, window_kernels_at(simd_level()));
///     transform.update(window, log_odds);          // looks at the columns marked in changed()
///     const int squared = transform.squared()[window.stored({0, 0, 0})];
///
/// Rows are computed again only if rows near them have changed, all of them after a move. Saito,
/// Toriwaki: New algorithms for Euclidean distance transformation (1994), with windows as wide as
/// the cap.

#include <locograph/world/perception/voxel_window.h>

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace locograph {

/// Aligned so that blocks of rows do not straddle cache lines.
template <class T>
using AlignedVector = std::vector<T, Eigen::aligned_allocator<T>>;

class WindowTransform {
 public:
  /// outside_is_obstacle: all that is outside of the window.
  WindowTransform(const VoxelWindow& window, int cap, ObstacleRange obstacle,
                  bool outside_is_obstacle, const WindowKernels& kernels);

  /// Blocks (y, block along x), as they are stored, in which an obstacle has come or gone; to be
  /// marked with 1.
  std::span<std::uint8_t> changed() { return changed_columns_; }
  /// The window has moved, or everything in it has changed.
  void change_everything();

  void update(const VoxelWindow& window, std::span<const std::int8_t> log_odds);

  /// As stored in the window; cap^2 + 1 for all that is farther than the cap.
  std::span<const std::int16_t> squared() const { return squared_; }

  std::size_t memory_bytes() const;

 private:
  int cap_;
  ObstacleRange obstacle_;
  bool outside_is_obstacle_;
  const WindowKernels& kernels_;
  std::vector<std::uint8_t> changed_columns_, changed_z_, changed_y_, reached_, flags_;
  AlignedVector<std::uint8_t> along_z_, column_;
  AlignedVector<std::int16_t> along_y_, squared_, rows_, line_;
};

}  // namespace locograph
