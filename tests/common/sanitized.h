#pragma once
/// Whether this is a build under a sanitizer: one that looks for bad memory, not at accuracy, and
/// takes ten times as long. Tests that repeat themselves do so less often there.
///
///     inline constexpr int kStates = kSanitized ? 12 : 120;

namespace locograph::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace locograph::test
