#pragma once
/// The hot loops of a window of voxels, compiled once for each level of vector instructions
/// (common/simd_level.h). Internal: LocalMap and WindowTransform call them.
///
/// All levels give the same bits: the loops have no sums across lanes, no products are fused with
/// sums, and divisions are those of IEEE.
///
/// Voxels lie in memory with x contiguous, then y, then z, as a ring along each axis: the voxel at
/// (x, y, z) of the window is stored at ((x + ring) mod size) of each axis. size[0] is a multiple
/// of kVoxelBlock; rings are multiples of 8.

#include <locograph/common/level_table.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace locograph {

/// Voxels along x that are handled, and marked as changed, together.
inline constexpr int kVoxelBlock = 32;
/// Log-odds of a voxel that was never seen.
inline constexpr std::int8_t kNeverSeen = -128;

struct RingWindow {
  int size[3], ring[3];
};

/// Which log-odds are obstacles: those for which (unsigned char)(value - first) <= span.
struct ObstacleRange {
  std::uint8_t first, span;
  bool holds(std::int8_t value) const {
    return static_cast<std::uint8_t>(static_cast<std::uint8_t>(value) - first) <= span;
  }
};

/// The image in minima. Level l has pixels at a stride of 2^(l + 1); each is the least depth [mm]
/// of the 4 x 4 strides that begin at it, 0 where nothing was seen.
struct PooledImage {
  static constexpr int kMostLevels = 6;
  const std::uint16_t* depth_mm;
  int width, height;
  int levels, level_width[kMostLevels], level_height[kMostLevels], offset[kMostLevels];
  std::uint16_t *block, *row;  ///< scratch: all levels; 2 (width + 4)
  std::int32_t* nearest;       ///< out: all levels
};

struct TouchedVoxel {
  std::int32_t voxel, depth_mm;  ///< where it is stored; that of one of its pixels
};
/// Counts of pixels in a voxel: up to kMostHits, and a flag for those that show the floor.
inline constexpr std::uint8_t kMostHits = 127, kFloorSeen = 128;

struct HitMarking {
  RingWindow window;
  const std::uint16_t* depth_mm;
  int width, height;
  const float* column;  ///< (u - cx) / fx
  float cy, inverse_fy;
  float rotation[9], origin[3];  ///< voxels of the window from optical millimetres
  int nearest_mm, farthest_mm;
  float floor;               ///< pixels below this z, in voxels of the window, show the floor
  std::int32_t *code, *run;  ///< scratch: width + 1 each
  std::uint8_t* hits;        ///< in, out: counts
  TouchedVoxel* touched;     ///< out: voxels whose count was 0
};

struct MissMarking {
  RingWindow window;
  const PooledImage* image;
  float fx, fy, cx, cy;
  /// Optical position of the window's first voxel's centre, and of one voxel more along x, y, z.
  float first[3], step[3][3];
  float nearest_m, farthest_m, footprint_px_m, margin_mm;
  std::int8_t miss, least;
  ObstacleRange obstacle;
  const std::uint8_t* hits;
  std::int8_t* log_odds;
  std::uint8_t* age;      ///< set to 0 where seen; may be null
  std::uint8_t* changed;  ///< out: blocks (y, x block) in which an obstacle came or went
  float *from, *to;       ///< scratch: size[1] each
  std::int32_t* free;     ///< scratch, all 0: size[0]
};

struct Ageing {
  RingWindow window;
  std::uint8_t most;  ///< what gets older than this was never seen
  ObstacleRange obstacle;
  std::int8_t* log_odds;
  std::uint8_t *age, *changed;
};

/// Squared distances [voxels^2] to the nearest obstacle along z, then in y and z, then in all axes.
/// Rows are blocks of kVoxelBlock voxels along x; a step looks at the rows near those that the step
/// before it has changed.
struct DistancePasses {
  RingWindow window;
  int cap;  ///< [voxels]: what is farther gets cap^2 + 1
  bool outside_is_obstacle;
  ObstacleRange obstacle;
  const std::int8_t* log_odds;
  std::uint8_t* changed_columns;        ///< (y, block); in of along_z(), which clears it
  std::uint8_t *changed_z, *changed_y;  ///< (z, y, block); the next step clears them
  std::uint8_t* reached;                ///< (z, y, block): is along_z below cap + 1 anywhere
  std::uint8_t* along_z;                ///< distance along z, at most cap + 1
  std::int16_t *along_y, *squared;
  std::uint8_t* column;  ///< scratch: size[2] blocks
  std::int16_t* rows;    ///< scratch: size[1] + 2 (cap + 4) blocks
  std::uint8_t* flags;   ///< scratch: 2 (size[1] + 2 (cap + 4)), and blocks
  std::int16_t* line;    ///< scratch: size[0] + 2 (cap + kVoxelBlock)
};

struct WindowKernels {
  void (*pool)(const PooledImage& image);
  int (*mark_hits)(const HitMarking& marking);  ///< the number of voxels touched
  void (*mark_misses)(const MissMarking& marking);
  void (*age)(const Ageing& ageing);
  void (*along_z)(const DistancePasses& passes);
  void (*along_y)(const DistancePasses& passes);
  void (*along_x)(const DistancePasses& passes);
};

/// Those of one of simd_levels(). Throws Error as require_simd_level() does.
const WindowKernels& window_kernels_at(const std::string& level);

// What window_kernels.cpp leaves behind, compiled for each level.
LOCOGRAPH_DECLARE_LEVELS(WindowKernels, window_kernels);

}  // namespace locograph
