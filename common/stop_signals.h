#pragma once
/// What Ctrl-C does (SIGINT, and likewise SIGTERM and SIGHUP): the program ends, its temporary
/// files are gone, and a job that has something to show for itself ends with that.
///
///     take_stop_signals();             // in main(): a library leaves signals to its program
///     {
///       const FinishOnSignal finish;   // the first signal only sets a flag, the next one ends all
///       while (!stop_requested()) try_another_start();
///     }

#include <atomic>
#include <exception>
#include <filesystem>

namespace locograph {

/// Once, at the start of the program. A signal that is ignored, as by nohup, stays ignored. A limit
/// on the size of files (ulimit -f) becomes an error of the write.
void take_stop_signals();

class FinishOnSignal {
 public:
  FinishOnSignal();
  ~FinishOnSignal();
  FinishOnSignal(const FinishOnSignal&) = delete;
  FinishOnSignal& operator=(const FinishOnSignal&) = delete;
};

/// Set by the first signal within a FinishOnSignal, and never cleared.
const std::atomic<bool>& stop_flag();
inline bool stop_requested() { return stop_flag().load(std::memory_order_relaxed); }

/// Thrown by a job that was asked to stop and has nothing to show.
struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};

/// Ends the program by the signal that asked it to stop, so that its caller knows.
[[noreturn]] void end_by_stop_signal();

/// A file that a signal removes while this lives.
class RemovedOnSignal {
 public:
  explicit RemovedOnSignal(const std::filesystem::path& file);
  ~RemovedOnSignal();
  RemovedOnSignal(const RemovedOnSignal&) = delete;
  RemovedOnSignal& operator=(const RemovedOnSignal&) = delete;

 private:
  int slot_ = -1;
};

}  // namespace locograph
