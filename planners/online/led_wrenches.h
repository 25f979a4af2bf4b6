#pragma once
/// Wrenches of a robot that is beside its plan and comes back to it.
///
///     carry_slopes(before, plan, graph, range, Rests::kMove);  // plan/slope_limits.h: the curve
///     balance_wrenches(plan, graph, range);                    // plan/carried_wrenches.h
///     lead_wrenches(plan, graph, {from, back});
///
/// Centimetres off, what a plan's contacts bear and what is added to it leave their cones. The
/// least wrenches of where the robot is (balance/least_wrenches.h) are inside, but are not those
/// that the plan goes on with. Both balance the robot, so each share of both does: from the least
/// ones at the beginning to the plan's at the end, as what the robot is off fades; less of the
/// plan's where contacts could not bear it.

#include <locograph/planners/plan/plan.h>
#include <locograph/planners/plan/slope_limits.h>

namespace locograph {

/// The share of what a robot was off that is left at this share of the time, both 0 to 1: 1 - 10
/// t^3 + 15 t^4 - 6 t^5, without velocity and acceleration at both ends.
double share_left(double time_share);

/// Of the configurations from the first one to the last one, which keeps its own; all but the last
/// one are in one stance. As much of the default execution margin is kept as there is. Nothing
/// changes where contacts do not bear the robot.
void lead_wrenches(const Plan& plan, Graph& graph, const PlanRange& range);

}  // namespace locograph
