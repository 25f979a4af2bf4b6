#include <locograph/common/simd_level.h>
#include <locograph/world/perception/window_kernels.h>

#include <algorithm>

namespace locograph {
namespace {

struct WindowLevel {
  const char* name;
  const WindowKernels& kernels;
};

constexpr WindowLevel kWindowLevels[] = {
#if LOCOGRAPH_X86_64_LEVELS
    {"v2", simd_v2::window_kernels},
    {"v3", simd_v3::window_kernels},
    {"v4", simd_v4::window_kernels},
#else
    {"portable", simd_portable::window_kernels},
#endif
};

}  // namespace

const WindowKernels& window_kernels_at(const std::string& level) {
  require_simd_level(level);
  return std::ranges::find(kWindowLevels, level, &WindowLevel::name)->kernels;
}

}  // namespace locograph
