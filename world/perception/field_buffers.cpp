#include <locograph/world/perception/field_buffers.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <new>
#include <vector>

namespace locograph {

struct FieldBuffers::Buffer {
  explicit Buffer(const LocalField& blank) : field(blank) {}

  LocalField field;
  std::atomic<bool> held = false;
  alignas(std::max_align_t) std::byte control[128];  // of the shared pointer
};

struct FieldBuffers::Pool {
  std::vector<std::unique_ptr<Buffer>> buffers;
};

/// An allocator for one object in the buffer; who holds it keeps all buffers alive. The last that a
/// shared pointer does is to give its memory back: the buffer is free then.
template <class T>
struct FieldBuffers::BesideBuffer {
  using value_type = T;

  std::shared_ptr<Pool> pool;
  Buffer* buffer;

  BesideBuffer(std::shared_ptr<Pool> the_pool, Buffer* the_buffer)
      : pool(std::move(the_pool)), buffer(the_buffer) {}
  template <class U>
  BesideBuffer(const BesideBuffer<U>& other) : pool(other.pool), buffer(other.buffer) {}

  T* allocate(std::size_t count) {
    if (count * sizeof(T) > sizeof buffer->control) throw std::bad_alloc();
    return reinterpret_cast<T*>(buffer->control);
  }
  void deallocate(T*, std::size_t) { buffer->held.store(false, std::memory_order_release); }

  template <class U>
  bool operator==(const BesideBuffer<U>& other) const {
    return buffer == other.buffer;
  }
};

FieldBuffers::FieldBuffers(const LocalField& blank, int count) : pool_(std::make_shared<Pool>()) {
  for (int i = 0; i < count; ++i) pool_->buffers.push_back(std::make_unique<Buffer>(blank));
}

LocalField& FieldBuffers::free_one() {
  for (const std::unique_ptr<Buffer>& buffer : pool_->buffers) {
    if (!buffer->held.load(std::memory_order_acquire)) return buffer->field;
  }
  pool_->buffers.push_back(std::make_unique<Buffer>(pool_->buffers.front()->field));
  return pool_->buffers.back()->field;
}

std::shared_ptr<const LocalField> FieldBuffers::share(const LocalField& field) {
  const auto found = std::ranges::find_if(
      pool_->buffers, [&](const auto& buffer) { return &buffer->field == &field; });
  Buffer* const buffer = found->get();
  buffer->held.store(true, std::memory_order_relaxed);
  const auto stays = [](const LocalField*) {};
  return std::shared_ptr<const LocalField>(&field, stays, BesideBuffer<LocalField>(pool_, buffer));
}

int FieldBuffers::count() const { return static_cast<int>(pool_->buffers.size()); }

}  // namespace locograph
