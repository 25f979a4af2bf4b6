#pragma once
/// Fork and join on a fixed number of threads, the caller's included.
///
///     ThreadPool threads(2);
///     threads.run(chunks, [&](int chunk) { sums[chunk] = sum(chunk); });   // waits for all
///
/// Which thread runs which chunk is left open; what a chunk computes must depend on its number
/// only. run() does not allocate, must not be nested and is called by one thread at a time. The
/// exception of the lowest chunk that threw is thrown again by run().

#include <locograph/common/error.h>

#include <atomic>
#include <exception>
#include <limits>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace locograph {

class ThreadPool {
 public:
  explicit ThreadPool(int threads) {
    if (threads < 1) throw Error("a thread pool of " + std::to_string(threads), "1 or more");
    for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { work(); });
  }
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  ~ThreadPool() {
    stop_ = true;
    round_.fetch_add(1, std::memory_order_release);
    round_.notify_all();
    for (std::thread& worker : workers_) worker.join();
  }

  int size() const { return static_cast<int>(workers_.size()) + 1; }

  template <class Task>
  void run(int count, Task&& task) {
    if (workers_.empty() || count <= 1) {
      for (int i = 0; i < count; ++i) task(i);
      return;
    }
    call_ = [](void* context, int i) {
      (*static_cast<std::remove_reference_t<Task>*>(context))(i);
    };
    context_ = const_cast<void*>(static_cast<const void*>(std::addressof(task)));
    count_ = count;
    next_.store(0, std::memory_order_relaxed);
    failed_ = std::numeric_limits<int>::max();
    busy_.store(static_cast<int>(workers_.size()), std::memory_order_relaxed);
    round_.fetch_add(1, std::memory_order_release);
    round_.notify_all();
    take_chunks();
    spin_until([this] { return busy_.load(std::memory_order_acquire) == 0; });
    for (int left; (left = busy_.load(std::memory_order_acquire)) != 0;) busy_.wait(left);
    if (failed_ != std::numeric_limits<int>::max())
      std::rethrow_exception(std::exchange(error_, {}));
  }

 private:
  /// Rounds follow each other within microseconds inside an iteration: waking a sleeper costs more.
  template <class Condition>
  static void spin_until(Condition&& done) {
    constexpr int kSpins = 4000;
    for (int i = 0; i < kSpins && !done(); ++i) {
#if defined(__x86_64__) || defined(__i386__)
      __builtin_ia32_pause();
#endif
    }
  }

  void take_chunks() {
    for (int i; (i = next_.fetch_add(1, std::memory_order_relaxed)) < count_;) {
      try {
        call_(context_, i);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(error_mutex_);
        if (i < failed_) {
          failed_ = i;
          error_ = std::current_exception();
        }
      }
    }
  }

  void work() {
    for (unsigned seen = 0;;) {
      spin_until([&] { return round_.load(std::memory_order_acquire) != seen; });
      round_.wait(seen, std::memory_order_acquire);
      seen = round_.load(std::memory_order_acquire);
      if (stop_) return;
      take_chunks();
      if (busy_.fetch_sub(1, std::memory_order_acq_rel) == 1) busy_.notify_one();
    }
  }

  std::vector<std::thread> workers_;
  std::atomic<unsigned> round_{0};
  std::atomic<int> next_{0}, busy_{0};
  std::atomic<bool> stop_{false};
  void (*call_)(void*, int) = nullptr;
  void* context_ = nullptr;
  int count_ = 0;
  std::mutex error_mutex_;
  std::exception_ptr error_;
  int failed_ = std::numeric_limits<int>::max();
};

}  // namespace locograph
