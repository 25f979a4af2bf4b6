#pragma once
/// Whether this is a build under a sanitizer: one that looks for bad memory, not at accuracy, and
/// takes ten times as long. Tests that repeat themselves do so less often there.
///
///     inline constexpr int kStates = kSanitized ? 12 : 120;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)  // GCC
#define LOCOGRAPH_SANITIZED
#elif defined(__has_feature)  // clang
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define LOCOGRAPH_SANITIZED
#endif
#endif

namespace locograph::test {

#ifdef LOCOGRAPH_SANITIZED
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace locograph::test
