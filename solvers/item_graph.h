#pragma once
/// Work items that depend on one another, run by the threads of a pool as they become ready; a
/// thread without a ready item helps another with the loop that it is in.
///
///     ItemGraph graph(dependencies, seconds);          // pairs (item, item that waits for it)
///     ItemRunner runner;
///     runner.prepare(graph.size(), threads.size());
///     runner.run(graph, &threads, [&](int item, const ItemRunner::Crew& crew) {
///       crew.share(chunks, [&](int chunk) { sums[item][chunk] = sum(item, chunk); });
///     });
///
/// Of the ready items the one with the longest path of work behind it comes first (list scheduling,
/// Hu 1961). Who runs what is left open: what an item or a chunk computes must not depend on it.
/// Without a pool items run in ascending order, so an item may only wait for lower ones. run() does
/// not allocate after prepare(), and no loop waits for a thread that has not joined it.

#include <locograph/common/thread_pool.h>

#include <atomic>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace locograph {

struct ItemGraph {
  std::vector<int> next_begin, next;  ///< items that wait for each
  std::vector<int> waits;             ///< for how many each waits
  std::vector<double> path;           ///< seconds from the start of each to the end of all after it

  ItemGraph() = default;
  ItemGraph(std::span<const std::pair<int, int>> dependencies, std::span<const double> seconds);
  int size() const { return static_cast<int>(waits.size()); }
};

class ItemRunner {
  struct alignas(64) Loop {
    std::atomic<bool> open{false};
    std::atomic<int> next{0}, helpers{0};
    void (*call)(void*, int) = nullptr;
    void* context = nullptr;
    int count = 0;
  };

 public:
  /// Memory for graphs of up to this size on up to this many threads; not while it runs.
  void prepare(int items, int threads);

  /// What an item gets to divide its work.
  class Crew {
   public:
    /// task(0) … task(count − 1), by this thread and those that have nothing else to do. Returns
    /// when all are done; must not be nested.
    template <class Task>
    void share(int count, Task&& task) const {
      if (loop_ == nullptr || count == 1) {
        for (int i = 0; i < count; ++i) task(i);
        return;
      }
      loop_->call = [](void* context, int i) {
        (*static_cast<std::remove_reference_t<Task>*>(context))(i);
      };
      loop_->context = const_cast<void*>(static_cast<const void*>(std::addressof(task)));
      loop_->count = count;
      loop_->next.store(0);
      loop_->open.store(true);
      for (int i; (i = loop_->next.fetch_add(1)) < count;) task(i);
      loop_->open.store(false);
      for (int spins = 0; loop_->helpers.load() != 0;) pause(spins);
    }

    /// Number of the thread that has the item, below the size of the pool.
    int thread() const { return thread_; }

   private:
    friend class ItemRunner;
    Loop* loop_ = nullptr;
    int thread_ = 0;
  };

  template <class Work>
  void run(const ItemGraph& graph, ThreadPool* threads, Work&& work) {
    if (!threads || threads->size() == 1 || graph.size() == 1) {
      for (int item = 0; item < graph.size(); ++item) work(item, Crew());
      return;
    }
    start(graph, threads->size());
    threads->run(threads->size(), [&](int thread) {
      Crew crew;
      crew.loop_ = &loops_[thread];
      crew.thread_ = thread;
      for (int item; (item = take(graph)) >= 0;) {
        work(item, crew);
        finish(graph, item);
      }
    });
  }

 private:
  void start(const ItemGraph& graph, int crew);
  /// The next item to run, or -1 when all are done; helps until there is one.
  int take(const ItemGraph& graph);
  void finish(const ItemGraph& graph, int item);
  bool help();
  void push(const ItemGraph& graph, int item);
  void lock();
  static void pause(int& spins);

  std::vector<int> waits_;
  std::vector<int> ready_;  ///< a heap by path
  int ready_count_ = 0;
  std::atomic<int> ready_hint_{0}, left_{0};
  std::atomic_flag lock_ = ATOMIC_FLAG_INIT;
  std::unique_ptr<Loop[]> loops_;
  int loop_capacity_ = 0;
  int crew_ = 1;
};

}  // namespace locograph
