#include <locograph/common/simd_level.h>
#include <locograph/solvers/kernels.h>
#include <locograph/solvers/level_tables.h>

#include <algorithm>

namespace locograph {
namespace {

#define LOCOGRAPH_LEVEL(name)                                                                 \
  Kernels {                                                                                   \
    .level = #name, .dense = simd_##name::dense_kernels, .front = simd_##name::front_kernels, \
    .panel = simd_##name::panel_solve, .schur = simd_##name::schur_kernels,                   \
    .pcg = simd_##name::pcg_kernels                                                           \
  }

constexpr Kernels kLevels[] = {
#if LOCOGRAPH_X86_64_LEVELS
    LOCOGRAPH_LEVEL(v2),
    LOCOGRAPH_LEVEL(v3),
    LOCOGRAPH_LEVEL(v4),
#else
    LOCOGRAPH_LEVEL(portable),
#endif
};

}  // namespace

const Kernels& kernels_at(const std::string& level) {
  require_simd_level(level);
  return *std::ranges::find(kLevels, level, &Kernels::level);
}

const Kernels& kernels() {
  static const Kernels& chosen = kernels_at(simd_level());
  return chosen;
}

}  // namespace locograph
