#include <locograph/common/error.h>
#include <locograph/common/simd_level.h>

#include <algorithm>
#include <cstdlib>

namespace locograph {
namespace {

struct Level {
  const char* name;
  bool (*is_here)();
};

// Asked for is what the kernels are made of; a processor that has it has the rest of the level.
constexpr Level kLevels[] = {
#if LOCOGRAPH_X86_64_LEVELS
    {"v2", [] { return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt"); }},
    {"v3",
     [] {
       return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
              __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
     }},
    {"v4",
     [] {
       return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
              __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
              __builtin_cpu_supports("avx512vl");
     }},
#else
    {"portable", [] { return true; }},
#endif
};

std::string best_level() {
  const std::vector<std::string> here = simd_levels();
  if (here.empty()) {
    throw Error("the processor lacks the instructions that locograph was built for",
                "at least SSE4.2 (x86-64-v2)");
  }
  return here.back();
}

std::string chosen_level() {
  const char* wanted = std::getenv("LOCOGRAPH_SIMD");
  if (wanted == nullptr || *wanted == '\0') return best_level();
  require_simd_level(wanted);
  return wanted;
}

}  // namespace

std::vector<std::string> simd_levels() {
  std::vector<std::string> names;
  for (const Level& level : kLevels) {
    if (level.is_here()) names.emplace_back(level.name);
  }
  return names;
}

void require_simd_level(const std::string& wanted) {
  const std::vector<std::string> here = simd_levels();
  if (std::ranges::find(here, wanted) != here.end()) return;
  const bool known = std::ranges::find(kLevels, wanted, &Level::name) != std::end(kLevels);
  const std::string problem = known ? "this processor lacks level" : "no level is called";
  std::string names;
  for (const std::string& name : here) names += (names.empty() ? "" : ", ") + name;
  throw Error("LOCOGRAPH_SIMD: " + problem + " '" + wanted + "'", "one of " + names);
}

const std::string& simd_level() {
  static const std::string chosen = chosen_level();
  return chosen;
}

}  // namespace locograph
