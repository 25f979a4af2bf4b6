#pragma once
/// How good a window of the online planner is, and which of two is better.
///
///     const WindowQuality had = window_quality(reader, step_of, steps, cost);
///     cost = optimise();
///     if (window_quality(reader, step_of, steps, cost).better_than(had)) keep();
///
/// Near steps count more than later ones. A feasible window is better than one that violates a
/// constraint. Of two that do, the better one is feasible for more steps, then violates less; of
/// two that do not, it costs less.

#include <locograph/core/violations.h>

#include <vector>

namespace locograph {

struct WindowQuality {
  int steps = 0;                ///< of the window
  int feasible_steps = 0;       ///< before the first one that violates a constraint
  ConstraintReader::Row worst;  ///< over the whole window; ratio ≤ 1: nothing is violated
  ConstraintReader::Row first;  ///< the worst one of the first step that violates a constraint
  double cost = 0.0;

  bool feasible() const { return worst.ratio <= 1.0; }
  bool better_than(const WindowQuality& other) const;
};

/// step_of: for each of Problem::constraints() the last step of the window that it is on, from 1.
WindowQuality window_quality(const ConstraintReader& reader, const std::vector<int>& step_of,
                             int steps, double cost);

}  // namespace locograph
