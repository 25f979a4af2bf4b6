#pragma once
/// When a job has to end: at a point in time, as soon as somebody asks for it, after a number of
/// iterations.
///
///     std::atomic<bool> stop = false;      // stop_flag() of stop_signals.h: set by Ctrl-C
///     const Termination termination{
///         .deadline = Deadline::after(5.0), .stop = &stop, .max_iterations = 3};
///     for (int tried = 0; !termination.ended(tried); ++tried) try_another_start();
///
/// The default never ends a job. A count ends it at the same place on every machine.

#include <locograph/common/check_option.h>
#include <locograph/common/deadline.h>

#include <algorithm>
#include <atomic>

namespace locograph {

struct Termination {
  Deadline deadline = {};
  /// When it is set the job ends; may be null.
  const std::atomic<bool>* stop = nullptr;
  int max_iterations = 0;  ///< 0: any number

  bool stopped() const { return stop != nullptr && *stop; }
  bool used_up(int iterations) const { return max_iterations > 0 && iterations >= max_iterations; }
  /// iterations: that the job has made.
  bool ended(int iterations = 0) const {
    return deadline.passed() || stopped() || used_up(iterations);
  }
  /// How many of `most` iterations may be made by a job that has made some.
  int left_of(int most, int iterations) const {
    return max_iterations > 0 ? std::clamp(max_iterations - iterations, 0, most) : most;
  }
  /// What is left of it, not used up, after some iterations.
  Termination after(int iterations) const {
    Termination rest = *this;
    if (max_iterations > 0) rest.max_iterations -= iterations;
    return rest;
  }

  /// Throws Error naming what is out of range.
  void validate() const { check_option(max_iterations >= 0, "max_iterations", "0 or more"); }

  bool operator==(const Termination&) const = default;
};

}  // namespace locograph
