#include <locograph/planners/offline/stance/transition_ahead.h>

#include <algorithm>

namespace locograph {

TransitionAhead::TransitionAhead(const TaskSolver& solver, int threads) {
  for (int i = 0; i < threads; ++i) {
    threads_.emplace_back(
        [this, own = solver](const std::stop_token& stop) mutable { work(stop, std::move(own)); });
  }
}

TransitionAhead::~TransitionAhead() {
  for (std::jthread& thread : threads_) thread.request_stop();
}

void TransitionAhead::expect(std::vector<Expected> expected) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const EntryPtr& entry : waiting_) entries_.erase(find(entry->expected.task));
  waiting_.clear();
  ++round_;
  for (Expected& one : expected) add(std::move(one), false);
  expected_.notify_all();
}

std::optional<TransitionResult> TransitionAhead::take(const TransitionTask& task) {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto found = find(task);
  if (found == entries_.end()) return std::nullopt;
  const EntryPtr entry = found->second;
  if (entry->state == Entry::kWaiting) std::erase(waiting_, entry);
  entries_.erase(found);
  entry->expected.then.reset();
  done_.wait(lock, [&] { return entry->state != Entry::kRunning; });
  if (entry->state != Entry::kDone) return std::nullopt;
  return std::move(entry->result);
}

void TransitionAhead::forget() {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++round_;
  waiting_.clear();
  entries_.clear();
}

TransitionAhead::Entries::iterator TransitionAhead::find(const TransitionTask& task) {
  const auto [begin, end] = entries_.equal_range(joined(task.larger, task.smaller));
  const auto found = std::find_if(
      begin, end, [&](const auto& entry) { return same_task(entry.second->expected.task, task); });
  return found == end ? entries_.end() : found;
}

void TransitionAhead::add(Expected expected, bool first) {
  const auto found = find(expected.task);
  if (found != entries_.end()) {
    Entry& known = *found->second;
    if (known.round == round_) return;  // what came first is likelier
    known.round = round_;
    known.expected.then = std::move(expected.then);
    if (known.state == Entry::kDone) follow_up(known);
    return;
  }
  const auto entry = std::make_shared<Entry>(Entry{std::move(expected), round_});
  const TransitionTask& task = entry->expected.task;
  entries_.emplace(joined(task.larger, task.smaller), entry);
  if (first) {
    waiting_.push_front(entry);
  } else {
    waiting_.push_back(entry);
  }
}

/// Before what is expected otherwise if it has only now been found.
void TransitionAhead::follow_up(const Entry& done) {
  if (!done.expected.then || !done.result.success() || done.round != round_) return;
  Expected next{*done.expected.then};
  next.task.start = done.result.configuration;
  if (next.task.before.size() > 0) next.task.before = done.result.configuration;
  add(std::move(next), done.state == Entry::kRunning);
}

void TransitionAhead::work(const std::stop_token& stop, TaskSolver solver) {
  std::unique_lock<std::mutex> lock(mutex_);
  while (expected_.wait(lock, stop, [this] { return !waiting_.empty(); }) &&
         !stop.stop_requested()) {
    const EntryPtr entry = std::move(waiting_.front());
    waiting_.pop_front();
    entry->state = Entry::kRunning;
    lock.unlock();
    try {
      TransitionResult result = solver.solve(entry->expected.task);
      lock.lock();
      entry->result = std::move(result);
      follow_up(*entry);
      entry->state = Entry::kDone;
    } catch (...) {
      // Who asks for it works it out again, and meets the exception.
      if (!lock.owns_lock()) lock.lock();
      entry->state = Entry::kThrown;
    }
    done_.notify_all();
  }
}

}  // namespace locograph
