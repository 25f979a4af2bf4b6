#pragma once
/// A point in time after which work should stop; the only clock that decisions may look at.
///
///     Deadline deadline = Deadline::after(0.010);     // seconds
///     while (!deadline.passed()) try_another_start();

#include <algorithm>
#include <chrono>
#include <optional>
#include <stdexcept>

namespace locograph {

/// Thrown where a part of a result is of no use, as of a world that is being loaded. No Error:
/// nothing was wrong.
struct OutOfTime : std::runtime_error {
  OutOfTime() : std::runtime_error("the time allowed is used up") {}
};

class Deadline {
 public:
  using Clock = std::chrono::steady_clock;

  /// Never passes.
  Deadline() = default;
  /// Of no seconds or less it has passed; one that is further off than a life never passes.
  static Deadline after(double seconds) {
    constexpr double kNever_s = 3e9;
    Deadline deadline;
    if (!(seconds < kNever_s)) return deadline;
    deadline.at_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(std::max(seconds, 0.0)));
    return deadline;
  }
  /// Of a limit as users give it: 0 seconds is none.
  static Deadline of_limit(double seconds) { return seconds > 0.0 ? after(seconds) : Deadline(); }
  bool operator==(const Deadline&) const = default;
  bool exists() const { return at_.has_value(); }
  bool passed() const { return at_ && Clock::now() >= *at_; }
  /// Throws OutOfTime when it has passed.
  void require() const {
    if (passed()) throw OutOfTime();
  }

 private:
  std::optional<Clock::time_point> at_;
};

/// Seconds since construction or the last lap().
class Stopwatch {
 public:
  double seconds() const { return since(begin_); }
  double lap() {
    const double elapsed = since(begin_);
    begin_ = Deadline::Clock::now();
    return elapsed;
  }

 private:
  static double since(Deadline::Clock::time_point begin) {
    return std::chrono::duration<double>(Deadline::Clock::now() - begin).count();
  }
  Deadline::Clock::time_point begin_ = Deadline::Clock::now();
};

}  // namespace locograph
