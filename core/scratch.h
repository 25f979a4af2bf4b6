#pragma once
/// A bump allocator for the run-time-sized temporaries of one edge: sized once, then never grows.
///
///     scratch.reset();
///     double* jacobian = scratch.array<double>(rows * columns);

#include <cassert>
#include <cstddef>
#include <memory>
#include <new>
#include <vector>

namespace locograph {

class Scratch {
 public:
  static constexpr std::size_t kAlignment = 64;

  /// Bytes that an array takes, alignment included.
  template <class T>
  static std::size_t bytes(std::size_t count) {
    return (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
  }

  void reserve(std::size_t bytes) {
    if (bytes + kAlignment > storage_.size()) storage_.resize(bytes + kAlignment);
  }
  void reset() { used_ = 0; }
  std::size_t mark() const { return used_; }
  void rewind(std::size_t mark) { used_ = mark; }

  /// Default-constructed elements; valid until reset().
  template <class T>
  T* array(std::size_t count) {
    void* start = storage_.data();
    std::size_t space = storage_.size();
    std::byte* aligned = static_cast<std::byte*>(std::align(kAlignment, 1, start, space));
    T* elements = reinterpret_cast<T*>(aligned + used_);
    used_ += bytes<T>(count);
    assert(used_ + kAlignment <= storage_.size() && "scratch memory is too small");
    std::uninitialized_default_construct_n(elements, count);
    return elements;
  }

 private:
  std::vector<std::byte> storage_;
  std::size_t used_ = 0;
};

}  // namespace locograph
