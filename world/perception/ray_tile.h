#pragma once
/// A few rays of a camera that are cast together: what each has met first so far.
///
///     RayTile tile;
///     tile.start(camera, 320, 240);
///     tile.meet(HalfSpaceEntry(optical_from_world.linear().col(2), -1.2), 7);   // 7: the floor
///     double depth_m = tile.depth[0];
///
/// Rays beyond the edge of the image repeat the last ones in it.

#include <locograph/world/perception/depth_camera.h>
#include <locograph/world/perception/ray_entries.h>

#include <algorithm>
#include <cstdint>

namespace locograph {

struct RayTile {
  static constexpr int kWide = 16, kHigh = 8, kRays = kWide * kHigh;

  alignas(64) double x[kRays], y[kRays];  ///< along (x, y, 1)
  alignas(64) double depth[kRays];        ///< of what was met first, or of the end of the range
  alignas(64) std::int64_t shows[kRays];  ///< whose that is, -1: nobody's
  double farthest = 0.0;                  ///< depth: what is beyond is hidden

  /// The pixels from (u, v) on to the right and down.
  void start(const DepthCamera& camera, int u, int v) {
    for (int row = 0; row < kHigh; ++row) {
      const double down = (std::min(v + row, camera.height - 1) - camera.cy) / camera.fy;
      for (int i = 0; i < kWide; ++i) {
        x[row * kWide + i] = (std::min(u + i, camera.width - 1) - camera.cx) / camera.fx;
        y[row * kWide + i] = down;
      }
    }
    for (double& end : depth) end = camera.range_max_m;
    for (std::int64_t& nobody : shows) nobody = -1;
    farthest = camera.range_max_m;
  }

  template <class Entry>
  void meet(const Entry entry, std::int64_t who) {
    for (int i = 0; i < kRays; ++i) {
      const double met = entry(x[i], y[i]);
      const bool is_first = met < depth[i];
      shows[i] = is_first ? who : shows[i];
      depth[i] = is_first ? met : depth[i];
    }
    look_how_far();
  }

  void look_how_far() {
    double most[kWide];
    for (int i = 0; i < kWide; ++i) most[i] = depth[i];
    for (int row = 1; row < kHigh; ++row) {
      for (int i = 0; i < kWide; ++i) {
        const double other = depth[row * kWide + i];
        most[i] = other > most[i] ? other : most[i];
      }
    }
    farthest = *std::max_element(most, most + kWide);
  }
};

}  // namespace locograph
