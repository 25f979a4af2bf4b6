#pragma once
/// A person walks across the way of the CENTAURO drive, which is refined and waits where it has to:
/// whether it arrives, and what the local planner says of its windows, beside what the judge says.
///
///     for (const Crossing& crossing : crossings(24)) {
///       const CrossingResult result = run_crossing(scenario, crossing, {});
///       if (result.wrongly_feasible > 0) …
///     }
///
/// Shared by a benchmark and a test.

#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/scenario/scenario.h>

#include <string>
#include <vector>

#include "judged_windows.h"

namespace locograph {

/// A cylinder of a person's size that walks along y at 0.5 m/s.
struct Crossing {
  double x_m = 0.0;      ///< where it meets the robot's way
  double delay_s = 0.0;  ///< it is there that much later than the robot's base was planned to be
  bool from_left = false;
};

/// Places along the drive, delays and sides, in turn.
std::vector<Crossing> crossings(int count);

struct CrossingResult : WindowCounts {
  bool arrived = false;         ///< and all of the motion is feasible for the judge
  bool stopped_safely = false;  ///< it is feasible, but does not arrive
  int waits = 0;
  double times_planned = 0.0;  ///< how many times as long as planned it took
  std::string reason, not_waited;
};

struct CrossingOptions {
  double rate_hz = 50.0;     ///< see WalkOptions
  int cycle_iterations = 1;  ///< likewise
  int every = 10;            ///< how many cycles from one window that is judged to the next
};

CrossingResult run_crossing(const Scenario& scenario, const Crossing& crossing,
                            const CrossingOptions& options);

}  // namespace locograph
