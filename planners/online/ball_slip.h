#pragma once
/// How far balls slip while they are held, in a plan that is being changed.
///
///     const auto slipping = most_slipped(online_plan, executed + 1, 0.9 * limits::kHeld_m);
///     if (slipping) std::cerr << slipping->ball << " slips by " << slipping->slip_m << " m\n";
///
/// Edges tolerate a little slip in each step (edge_ball_rolling.h), the judge counts what it adds
/// up to since the ball touched down: of steps that are judged one by one nobody does.

#include <locograph/planners/online/online_plan.h>

#include <optional>
#include <string>

namespace locograph {

struct BallSlip {
  std::string ball;
  double slip_m = 0.0;
};

/// Of the balls that are held until a configuration, that whose skin has slipped furthest since it
/// touched down, by the rows of EDGE_BALL_ROLLING, if that is more than most_m. Balls whose
/// configurations all are as planned do not count: the plan was judged.
std::optional<BallSlip> most_slipped(const OnlinePlan& plan, int configuration, double most_m);

}  // namespace locograph
