#pragma once
/// A depth image, stamped.

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
