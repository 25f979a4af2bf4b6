#pragma once
/// A point in time after which work should stop; the only clock that decisions may look at.
///
///     Deadline deadline = Deadline::after(0.010);     // seconds
///     while (!deadline.passed()) try_another_start();

#include <chrono>
#include <optional>

namespace locograph {

class Deadline {
 public:
  using Clock = std::chrono::steady_clock;

  /// Never passes.
  Deadline() = default;
  static Deadline after(double seconds) {
    Deadline deadline;
    deadline.at_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(seconds));
    return deadline;
  }
  bool exists() const { return at_.has_value(); }
  bool passed() const { return at_ && Clock::now() >= *at_; }

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
