#pragma once
/// Mean and percentiles of a list of figures, as the commands report them.
///
///     Json times = statistics_json(cycle_times);     // {mean, p50, p95, p99, max}

#include <locograph/apps/output.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace locograph {

/// The smallest of the sorted values that at least a fraction p of them do not exceed; 0 for none.
inline double percentile(const std::vector<double>& sorted, double p) {
  if (sorted.empty()) return 0.0;
  const double rank = std::ceil(p * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(1.0, rank)) - 1];
}

inline Json statistics_json(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  return {{"mean", values.empty() ? 0.0 : sum / static_cast<double>(values.size())},
          {"p50", percentile(values, 0.50)},
          {"p95", percentile(values, 0.95)},
          {"p99", percentile(values, 0.99)},
          {"max", values.empty() ? 0.0 : values.back()}};
}

}  // namespace locograph
