#pragma once
/// What a depth camera saw at one time.
///
///     DepthImage image{.stamp_s = 12.5, .camera = 0, .width = 640, .height = 480};
///     image.depth_mm.assign(640 * 480, 0);  // nothing seen

#include <cstdint>
#include <vector>

namespace locograph {

struct DepthImage {
  double stamp_s = 0.0;
  int camera = 0;  ///< index into the list of cameras
  int width = 0, height = 0;
  std::vector<std::uint16_t> depth_mm;  ///< row by row, along the optical z; 0: nothing seen
};

}  // namespace locograph
