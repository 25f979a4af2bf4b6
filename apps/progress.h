#pragma once
/// One line on stderr that tells how a long job is getting on: only on a terminal, after a second.
///
///     Progress progress;
///     while (work()) progress.show([&] { return "iteration " + std::to_string(i); });
///
/// The line is erased when the Progress goes out of scope.

#include <locograph/common/deadline.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace locograph {

class Progress {
 public:
  Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }

  /// text: called only when a line is due, five times a second.
  template <class Text>
  void show(Text&& text) {
    if (!terminal_ || job_.seconds() < 1.0 || (shown_ && line_.seconds() < 0.2)) return;
    const std::string line = text();
    std::fprintf(stderr, "\r\033[K%s", line.c_str());
    std::fflush(stderr);
    shown_ = true;
    line_.lap();
  }

 private:
  bool terminal_ = ::isatty(STDERR_FILENO) != 0;
  bool shown_ = false;
  Stopwatch job_, line_;
};

}  // namespace locograph
