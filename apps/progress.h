#pragma once
/// One line on stderr that tells how a long job is getting on: only on a terminal, after a second,
/// and not with --quiet.
///
///     Progress progress("refining");
///     for (int i = 0; i < steps; ++i) {
///       work(i);
///       progress.show(static_cast<double>(i + 1) / steps, [&] { return "step " + name(i); });
///     }
///     // refining [#########-----------] 45 %, 8 s to go, step turn_left
///
/// A job that does not say how far it is shows what is being done and for how long. The line is
/// erased when the Progress goes out of scope. Everything is to be called by one thread.

#include <locograph/common/deadline.h>

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace locograph {

class Progress {
 public:
  /// what: what is being done.
  explicit Progress(const std::string& what);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// fraction: of the work that is done, 0 to 1; nothing where nobody knows. text: called only when
  /// a line is due, some times a second.
  template <class Text>
  void show(std::optional<double> fraction, Text&& text) {
    if (!painter_.joinable() || since_.seconds() < kInterval_s) return;
    since_.lap();
    take(fraction, text());
  }
  void show(std::optional<double> fraction) {
    show(fraction, [] { return std::string(); });
  }

 private:
  static constexpr double kInterval_s = 0.1;

  void take(std::optional<double> fraction, std::string text);
  void paint();

  const std::string what_;
  const Stopwatch job_;
  Stopwatch since_;

  std::mutex mutex_;  ///< of everything below
  std::condition_variable changed_;
  std::optional<double> fraction_;
  std::string text_;
  bool ended_ = false;
  std::thread painter_;
};

/// The line that is shown, `seconds` after the job began: "what [##--] 50 %, 3 s to go, text".
std::string progress_line(const std::string& what, double seconds, std::optional<double> fraction,
                          const std::string& text);

}  // namespace locograph
