#include <locograph/common/error.h>
#include <locograph/solvers/kernels.h>
#include <locograph/solvers/level_tables.h>

#include <cstdlib>

namespace locograph {
namespace {

struct Level {
  Kernels kernels;
  bool (*is_here)();
};

#define LOCOGRAPH_LEVEL(name)                                                                 \
  Kernels {                                                                                   \
    .level = #name, .dense = simd_##name::dense_kernels, .front = simd_##name::front_kernels, \
    .panel = simd_##name::panel_solve, .schur = simd_##name::schur_kernels,                   \
    .pcg = simd_##name::pcg_kernels                                                           \
  }

// Asked for is what the kernels are made of; a processor that has it has the rest of the level.
constexpr Level kLevels[] = {
#if LOCOGRAPH_X86_64_LEVELS
    {LOCOGRAPH_LEVEL(v2),
     [] { return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt"); }},
    {LOCOGRAPH_LEVEL(v3),
     [] {
       return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
              __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
     }},
    {LOCOGRAPH_LEVEL(v4),
     [] {
       return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
              __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
              __builtin_cpu_supports("avx512vl");
     }},
#else
    {LOCOGRAPH_LEVEL(portable), [] { return true; }},
#endif
};

const Kernels& best() {
  const Kernels* found = nullptr;
  for (const Level& level : kLevels) {
    if (level.is_here()) found = &level.kernels;
  }
  if (found == nullptr) {
    throw Error("the processor lacks the instructions that locograph was built for",
                "at least SSE4.2 (x86-64-v2)");
  }
  return *found;
}

const Kernels& choose() {
  const char* wanted = std::getenv("LOCOGRAPH_SIMD");
  return wanted == nullptr || *wanted == '\0' ? best() : kernels_at(wanted);
}

}  // namespace

std::vector<std::string> kernel_levels() {
  std::vector<std::string> names;
  for (const Level& level : kLevels) {
    if (level.is_here()) names.emplace_back(level.kernels.level);
  }
  return names;
}

const Kernels& kernels_at(const std::string& wanted) {
  std::string here;
  bool known = false;
  for (const Level& level : kLevels) {
    const bool named = wanted == level.kernels.level;
    known = known || named;
    if (!level.is_here()) continue;
    if (named) return level.kernels;
    here += (here.empty() ? "" : ", ") + std::string(level.kernels.level);
  }
  const std::string problem = known ? "this processor lacks level" : "no level is called";
  throw Error("LOCOGRAPH_SIMD: " + problem + " '" + wanted + "'", "one of " + here);
}

const Kernels& kernels() {
  static const Kernels& chosen = choose();
  return chosen;
}

}  // namespace locograph
