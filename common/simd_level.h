#pragma once
/// The level of vector instructions that kernels run at. Kernels are compiled once for each level
/// of x86-64: v2 (SSE4.2), v3 (AVX2, fused multiply-add) and v4 (AVX-512); for other processors
/// once, "portable".
///
///     std::cout << simd_level() << '\n';                        // "v3"
///     for (const std::string& level : simd_levels()) require_simd_level(level);
///
/// The highest that the machine has is taken, unless the environment variable LOCOGRAPH_SIMD names
/// another.

#include <string>
#include <vector>

namespace locograph {

/// The levels that this machine has, lowest first.
std::vector<std::string> simd_levels();

/// Throws Error for what is none of simd_levels().
void require_simd_level(const std::string& level);

/// The one of this process, chosen when it is first asked for. Throws Error when LOCOGRAPH_SIMD
/// names no level, or one that the machine lacks.
const std::string& simd_level();

}  // namespace locograph
