#pragma once
/// A grow-only array of doubles on a cache-line boundary, not initialised: the factor is written
/// before it is read, and large ones ask for large pages.
///
///     AlignedMemory factor;
///     factor.reserve(1000000);      // what it held is lost
///     factor.data()[0] = 1.0;

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace locograph {

class AlignedMemory {
 public:
  void reserve(std::int64_t count) {
    if (count <= capacity_) return;
    memory_.reset();
    capacity_ = 0;
    const std::size_t large_page = std::size_t{1} << 21;
    const std::size_t wanted = static_cast<std::size_t>(count) * sizeof(double);
    const std::size_t alignment = wanted >= 2 * large_page ? large_page : 64;
    const std::size_t bytes = (wanted + alignment - 1) / alignment * alignment;
    memory_.reset(static_cast<double*>(std::aligned_alloc(alignment, bytes)));
    if (!memory_) throw std::bad_alloc();
#if defined(__linux__)
    if (alignment == large_page) madvise(memory_.get(), bytes, MADV_HUGEPAGE);
#endif
    capacity_ = count;
  }
  double* data() { return memory_.get(); }
  const double* data() const { return memory_.get(); }

 private:
  struct Free {
    void operator()(double* p) const { std::free(p); }
  };
  std::unique_ptr<double, Free> memory_;
  std::int64_t capacity_ = 0;
};

}  // namespace locograph
