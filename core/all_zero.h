#pragma once
/// Of hundreds of limits few are reached: what rests is found many numbers at a time.

#include <cstdint>
#include <cstring>

namespace locograph {

/// Whether n numbers are all 0; -0 counts as another number.
inline bool all_zero(const double* from, int n) {
  constexpr int kTogether = 8;
  std::uint64_t bits[kTogether];
  int i = 0;
  for (; i + kTogether <= n; i += kTogether) {
    std::memcpy(bits, from + i, sizeof bits);
    std::uint64_t any = 0;
    for (const std::uint64_t one : bits) any |= one;
    if (any != 0) return false;
  }
  for (; i < n; ++i) {
    std::memcpy(bits, from + i, sizeof(double));
    if (bits[0] != 0) return false;
  }
  return true;
}

}  // namespace locograph
