#include "common/allocation_counter.h"

#include <atomic>
#include <cerrno>
#include <cstddef>

#include "common/sanitized.h"

#if defined(__GLIBC__) && !defined(LOCOGRAPH_SANITIZED)

namespace {
std::atomic<long> allocations = 0;
}

// glibc lets a program replace these and keeps its own under the names __libc_*; operator new of
// libstdc++ ends here too.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) noexcept {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) noexcept {
  ++allocations;
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++allocations;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** result, std::size_t alignment, std::size_t size) noexcept {
  ++allocations;
  *result = __libc_memalign(alignment, size);
  return *result == nullptr ? ENOMEM : 0;
}
}

bool locograph::test::allocations_are_counted() { return true; }
long locograph::test::allocation_count() { return allocations; }

#else

bool locograph::test::allocations_are_counted() { return false; }
long locograph::test::allocation_count() { return 0; }

#endif
