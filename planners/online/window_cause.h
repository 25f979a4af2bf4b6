#pragma once
/// Why a robot cannot follow its plan any further.
///
///     if (const std::optional<WindowCause> cause = find_cause(online, 12, 32))
///       std::cerr << cause->text << '\n';
///     // obstacle_distance: wheel_2 near an obstacle (box), by 0.21 m at vertex 20
///
/// When an obstacle is in the way, an optimiser violates whichever constraint gives most easily:
/// its worst violation may be a wheel that slips on the way round the obstacle. The plan as it came
/// kept all constraints when it was made. Of those that it violates now, the first one along the
/// plan is the cause.

#include <locograph/core/violations.h>
#include <locograph/planners/online/online_plan.h>

#include <optional>
#include <string>
#include <vector>

namespace locograph {

struct WindowCause {
  ConstraintViolation violation;
  int at = 0;        ///< index in the plan
  std::string text;  ///< one line; names the obstacle if there is one
};

/// "obstacle_distance" for EDGE_OBSTACLE_DISTANCE.
std::string constraint_name(const std::string& tag);

/// One line about a constraint that is violated at a vertex.
std::string violated_text(const ConstraintViolation& violation, int vertex);

/// Looks at the configurations after `executed` up to `last` where they were planned. Nothing when
/// they violate no constraint there, in the world as it is known now. The graph is left as it was.
std::optional<WindowCause> find_cause(const OnlinePlan& plan, int executed, int last);

}  // namespace locograph
