#pragma once
/// A random number between two others, the same bits with every compiler and standard library.
///
///     std::mt19937_64 random(7);
///     double angle_rad = uniform(random, -0.5, 0.5);
///
/// The standard says what its engines give, but not what its distributions make of it. Here it is
/// the upper 53 of 64 bits; of an engine with 32 bits two numbers, the second one on top.

#include <cstdint>
#include <random>

namespace locograph {

/// In [lower, upper], evenly; engine: std::mt19937 or std::mt19937_64.
template <class Engine>
double uniform(Engine& engine, double lower, double upper) {
  static_assert(Engine::min() == 0 && (Engine::max() == UINT32_MAX || Engine::max() == UINT64_MAX),
                "an engine whose every bit is random");
  std::uint64_t bits = engine();
  if constexpr (Engine::max() == UINT32_MAX) bits |= std::uint64_t{engine()} << 32;
  return lower + (upper - lower) * 0x1.0p-53 * static_cast<double>(bits >> 11);
}

}  // namespace locograph
