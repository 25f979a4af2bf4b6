#pragma once
/// The kernels of a source that is compiled once for each level of vector instructions, and the
/// choice among them: at_level<RowKernels>(LOCOGRAPH_LEVEL_TABLE(row_kernels), level), in a source
/// that CMake calls a chooser (cmake/LocographLevels.cmake).

#include <locograph/common/simd_level.h>

#include <algorithm>
#include <initializer_list>
#include <string>

namespace locograph {

template <class Kernels>
struct AtLevel {
  const char* name;
  const Kernels* kernels;
};

/// Throws Error like require_simd_level().
template <class Kernels>
const Kernels& at_level(std::initializer_list<AtLevel<Kernels>> table, const std::string& level) {
  require_simd_level(level);
  return *std::ranges::find(table, level, &AtLevel<Kernels>::name)->kernels;
}

#if LOCOGRAPH_X86_64_LEVELS
#define LOCOGRAPH_LEVEL_TABLE(kernels)                                                \
  {                                                                                   \
    {"v2", &simd_v2::kernels}, {"v3", &simd_v3::kernels}, { "v4", &simd_v4::kernels } \
  }
#else
#define LOCOGRAPH_LEVEL_TABLE(kernels)      \
  {                                         \
    { "portable", &simd_portable::kernels } \
  }
#endif

/// Declares the table `kernels` of type Kernels in the namespace of each level.
#define LOCOGRAPH_DECLARE_LEVELS(Kernels, kernels) \
  namespace simd_v2 {                              \
  extern const Kernels kernels;                    \
  }                                                \
  namespace simd_v3 {                              \
  extern const Kernels kernels;                    \
  }                                                \
  namespace simd_v4 {                              \
  extern const Kernels kernels;                    \
  }                                                \
  namespace simd_portable {                        \
  extern const Kernels kernels;                    \
  }                                                \
  static_assert(true, "")

}  // namespace locograph
