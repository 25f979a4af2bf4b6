#pragma once
/// What the campaigns of perception measure times with, and how they tell what they measured.
///
///     const double begin = processor_ms();
///     work();
///     times.push_back(processor_ms() - begin);
///     std::cout << spread(times).dump() << '\n';

#include <time.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

namespace locograph {

/// Of this thread.
inline double processor_ms() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// Of this process.
inline double resident_megabytes() {
  std::ifstream file("/proc/self/statm");
  double size = 0.0, resident = 0.0;
  file >> size >> resident;
  return resident * 4096.0 / 1e6;
}

/// The least value that this share of them does not exceed; 0 of none.
inline double percentile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0.0;
  const auto at = static_cast<std::size_t>(share * static_cast<double>(sorted.size()));
  return sorted[std::min(at, sorted.size() - 1)];
}

inline nlohmann::ordered_json spread(std::vector<double> values) {
  std::ranges::sort(values);
  double sum = 0.0;
  for (const double value : values) sum += value;
  return {{"mean", values.empty() ? 0.0 : sum / static_cast<double>(values.size())},
          {"median", percentile(values, 0.5)},
          {"p99", percentile(values, 0.99)},
          {"max", values.empty() ? 0.0 : values.back()},
          {"count", values.size()}};
}

}  // namespace locograph
