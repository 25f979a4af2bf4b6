#include <locograph/apps/output.h>
#include <locograph/apps/progress.h>
#include <locograph/common/control_characters.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

namespace locograph {
namespace {

constexpr double kShort_s = 1.0;  // nothing is shown of a job that ends before
constexpr auto kFrame = std::chrono::milliseconds(200);
constexpr int kBarLetters = 20;

std::string duration_text(double seconds) {
  const long whole = std::lround(std::min(seconds, 1e9));
  if (whole < 120) return std::to_string(whole) + " s";
  if (whole < 7200) return std::to_string(whole / 60) + " min";
  return std::to_string(whole / 3600) + " h";
}

int terminal_width() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return known ? size.ws_col : 80;
}

}  // namespace

std::string progress_line(const std::string& what, double seconds, std::optional<double> fraction,
                          const std::string& text) {
  std::string line = what;
  if (fraction) {
    const double done = std::clamp(*fraction, 0.0, 1.0);
    const int letters = static_cast<int>(done * kBarLetters);
    line += " [" + std::string(letters, '#') + std::string(kBarLetters - letters, '-') + "] " +
            std::to_string(static_cast<int>(100.0 * done)) + " %";
    if (done > 0.0) line += ", " + duration_text(seconds * (1.0 - done) / done) + " to go";
  } else {
    line += ", " + duration_text(seconds);
  }
  return line + (text.empty() ? "" : ", " + text);
}

Progress::Progress(const std::string& what) : what_(without_controls(what, "\\x")) {
  if (!is_quiet() && ::isatty(STDERR_FILENO) != 0) painter_ = std::thread([this] { paint(); });
}

Progress::~Progress() {
  if (!painter_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_one();
  painter_.join();
}

void Progress::take(std::optional<double> fraction, std::string text) {
  const std::lock_guard lock(mutex_);
  fraction_ = fraction;
  text_ = std::move(text);
}

void Progress::paint() {
  bool shown = false;
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, kFrame, [this] { return ended_; })) {
    const double seconds = job_.seconds();
    if (seconds < kShort_s) continue;
    // A line that wraps could not be erased.
    const std::string line = progress_line(what_, seconds, fraction_, text_);
    std::fprintf(stderr, "\r\033[K%.*s", terminal_width() - 1, line.c_str());
    std::fflush(stderr);
    shown = true;
  }
  if (shown) std::fputs("\r\033[K", stderr);
}

}  // namespace locograph
