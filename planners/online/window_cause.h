#pragma once
/// What keeps a robot from going on as planned.
///
///     if (const std::optional<WindowCause> cause = find_cause(graph, plan, planned, 12, 32))
///       std::cerr << cause->text << '\n';
///     // obstacle_distance: wheel_2 near an obstacle (box), by 0.21 m at vertex 20
///
/// When something is in the way, an optimiser bends whatever gives: what it violates most in the
/// end may be the wheel that slips on the way round. The plan as it came kept its constraints when
/// it was made; of those it violates now, the one that comes first is why it cannot be followed.

#include <locograph/core/violations.h>
#include <locograph/planners/plan/plan.h>

#include <optional>
#include <string>
#include <vector>

namespace locograph {

struct WindowCause {
  ConstraintViolation violation;
  int at = 0;        ///< index in the plan
  std::string text;  ///< one line; names the obstacle where it is one
};

/// "obstacle_distance" for EDGE_OBSTACLE_DISTANCE.
std::string constraint_name(const std::string& tag);

/// Of the configurations behind `executed` up to `last`, put where they were planned. Nothing when
/// they violate no constraint. The graph is left as it was.
std::optional<WindowCause> find_cause(Graph& graph, const Plan& plan,
                                      const std::vector<Eigen::VectorXd>& planned, int executed,
                                      int last);

}  // namespace locograph
