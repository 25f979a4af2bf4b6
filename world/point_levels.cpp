#include <locograph/common/level_table.h>
#include <locograph/world/point_kernels.h>

namespace locograph {

const PointKernels& point_kernels_at(const std::string& level) {
  return at_level<PointKernels>(LOCOGRAPH_LEVEL_TABLE(point_kernels), level);
}

const PointKernels& point_kernels() {
  static const PointKernels& chosen = point_kernels_at(simd_level());
  return chosen;
}

}  // namespace locograph
