#include <locograph/solvers/item_graph.h>

#include <algorithm>
#include <thread>

namespace locograph {

ItemGraph::ItemGraph(std::span<const std::pair<int, int>> dependencies,
                     std::span<const double> seconds) {
  const int n = static_cast<int>(seconds.size());
  waits.assign(n, 0);
  next_begin.assign(n + 1, 0);
  for (const auto& [item, waiting] : dependencies) {
    ++next_begin[item + 1];
    ++waits[waiting];
  }
  for (int i = 0; i < n; ++i) next_begin[i + 1] += next_begin[i];
  next.resize(dependencies.size());
  std::vector<int> at(next_begin.begin(), next_begin.end() - 1);
  for (const auto& [item, waiting] : dependencies) next[at[item]++] = waiting;
  path.assign(seconds.begin(), seconds.end());
  for (int i = n - 1; i >= 0; --i) {
    double longest = 0.0;
    for (int k = next_begin[i]; k < next_begin[i + 1]; ++k) {
      longest = std::max(longest, path[next[k]]);
    }
    path[i] += longest;
  }
}

void ItemRunner::prepare(int items, int threads) {
  waits_.resize(std::max<std::size_t>(waits_.size(), items));
  ready_.resize(waits_.size());
  if (threads > loop_capacity_) {
    loops_ = std::make_unique<Loop[]>(threads);
    loop_capacity_ = threads;
  }
}

void ItemRunner::start(const ItemGraph& graph, int crew) {
  crew_ = crew;
  ready_count_ = 0;
  left_.store(graph.size());
  for (int i = 0; i < graph.size(); ++i) {
    waits_[i] = graph.waits[i];
    if (waits_[i] == 0) push(graph, i);
  }
  ready_hint_.store(ready_count_);
}

void ItemRunner::push(const ItemGraph& graph, int item) {
  ready_[ready_count_++] = item;
  std::push_heap(ready_.begin(), ready_.begin() + ready_count_,
                 [&](int a, int b) { return graph.path[a] < graph.path[b]; });
}

void ItemRunner::lock() {
  for (int spins = 0; lock_.test_and_set(std::memory_order_acquire);) pause(spins);
}

int ItemRunner::take(const ItemGraph& graph) {
  for (int spins = 0; left_.load(std::memory_order_acquire) > 0;) {
    if (ready_hint_.load(std::memory_order_relaxed) > 0) {
      lock();
      int item = -1;
      if (ready_count_ > 0) {
        std::pop_heap(ready_.begin(), ready_.begin() + ready_count_,
                      [&](int a, int b) { return graph.path[a] < graph.path[b]; });
        item = ready_[--ready_count_];
        ready_hint_.store(ready_count_, std::memory_order_relaxed);
      }
      lock_.clear(std::memory_order_release);
      if (item >= 0) return item;
    }
    if (help()) {
      spins = 0;
    } else {
      pause(spins);
    }
  }
  return -1;
}

void ItemRunner::finish(const ItemGraph& graph, int item) {
  lock();
  for (int k = graph.next_begin[item]; k < graph.next_begin[item + 1]; ++k) {
    if (--waits_[graph.next[k]] == 0) push(graph, graph.next[k]);
  }
  ready_hint_.store(ready_count_, std::memory_order_relaxed);
  lock_.clear(std::memory_order_release);
  left_.fetch_sub(1, std::memory_order_acq_rel);
}

/// A helper announces itself before it looks whether the loop is open, its owner closes the loop
/// before it looks for helpers: one of the two sees the other.
bool ItemRunner::help() {
  bool helped = false;
  for (int t = 0; t < crew_; ++t) {
    Loop& loop = loops_[t];
    if (!loop.open.load(std::memory_order_relaxed)) continue;
    loop.helpers.fetch_add(1);
    if (loop.open.load()) {
      for (int i; (i = loop.next.fetch_add(1)) < loop.count;) {
        loop.call(loop.context, i);
        helped = true;
      }
    }
    loop.helpers.fetch_sub(1);
  }
  return helped;
}

/// Waits are microseconds long; where threads are more than processors, others should have their
/// turn.
void ItemRunner::pause(int& spins) {
  if (++spins > 2000) {
    std::this_thread::yield();
    return;
  }
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

}  // namespace locograph
