#pragma once
/// Transitions worked out before a search asks for them, on threads of their own. The search stays
/// on its thread and keeps its order: it is given what it would have worked out itself, bit for
/// bit, so that the number of threads changes nothing but the time.
///
///     TransitionAhead ahead(solver, 1);
///     ahead.expect({{likeliest}, {lift, put}});
///     std::optional<TransitionResult> result = ahead.take(transition);
///     if (!result) result = solver.solve(transition);

#include <locograph/planners/offline/stance/transition_task.h>

#include <condition_variable>
#include <deque>
#include <memory>
#include <optional>
#include <stop_token>
#include <thread>

namespace locograph {

class TransitionAhead {
 public:
  /// What may be asked for next. `then`: what follows where it is found, from the configuration
  /// that was found.
  struct Expected {
    TransitionTask task;
    std::optional<TransitionTask> then = {};
  };

  /// Each thread has a copy of the solver, whose references must outlive this.
  TransitionAhead(const TaskSolver& solver, int threads);
  TransitionAhead(const TransitionAhead&) = delete;
  TransitionAhead& operator=(const TransitionAhead&) = delete;
  /// Waits for the transitions that are being worked out.
  ~TransitionAhead();

  /// The likeliest first; replaces what was expected before and is not begun.
  void expect(std::vector<Expected> expected);
  /// What came of a task that is done, or being done: then it waits. Otherwise nothing, and so
  /// where solving threw: who asks does it and meets the exception.
  std::optional<TransitionResult> take(const TransitionTask& task);
  /// Results that were not asked for are dropped.
  void forget();

 private:
  struct Entry {
    Expected expected;
    int round;  ///< of expect()
    enum { kWaiting, kRunning, kDone, kThrown } state = kWaiting;
    TransitionResult result = {};
  };
  using EntryPtr = std::shared_ptr<Entry>;
  using Entries = std::unordered_multimap<Footing, EntryPtr, FootingHash>;

  void work(const std::stop_token& stop, TaskSolver solver);
  Entries::iterator find(const TransitionTask& task);
  /// first: before what waits already.
  void add(Expected expected, bool first);
  void follow_up(const Entry& done);

  std::mutex mutex_;
  std::condition_variable_any expected_, done_;
  int round_ = 0;
  std::deque<EntryPtr> waiting_;
  Entries entries_;  ///< waiting, running and done, by their footings
  std::vector<std::jthread> threads_;
};

}  // namespace locograph
