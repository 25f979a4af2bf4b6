#include <locograph/common/level_table.h>
#include <locograph/world/perception/window_kernels.h>

namespace locograph {

const WindowKernels& window_kernels_at(const std::string& level) {
  return at_level<WindowKernels>(LOCOGRAPH_LEVEL_TABLE(window_kernels), level);
}

}  // namespace locograph
