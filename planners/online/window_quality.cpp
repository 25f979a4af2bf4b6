#include <locograph/planners/online/window_quality.h>

#include <algorithm>

namespace locograph {

bool WindowQuality::better_than(const WindowQuality& other) const {
  if (feasible() != other.feasible()) return feasible();
  if (feasible_steps != other.feasible_steps) return feasible_steps > other.feasible_steps;
  if (!feasible() && worst.ratio != other.worst.ratio) return worst.ratio < other.worst.ratio;
  return cost < other.cost;
}

WindowQuality window_quality(const ConstraintReader& reader, const std::vector<int>& step_of,
                             int steps, double cost) {
  WindowQuality quality;
  quality.steps = steps;
  quality.feasible_steps = steps;
  quality.cost = cost;
  reader.each([&](const ConstraintReader::Row& row) {
    if (row.ratio > quality.worst.ratio) quality.worst = row;
    if (row.ratio <= 1.0) return;
    const int before = step_of[static_cast<std::size_t>(row.constraint)] - 1;
    if (before > quality.feasible_steps) return;
    if (before < quality.feasible_steps || row.ratio > quality.first.ratio) quality.first = row;
    quality.feasible_steps = before;
  });
  return quality;
}

}  // namespace locograph
