#pragma once
/// Wrenches for a plan that has been changed: they hold the robot as it moves now.
///
///     const Motion before = motion_of_slopes(graph, plan);   // slope_limits.h
///     carry_slopes(before, plan, graph);                     // the curve first
///     carry_wrenches(before, plan, graph);
///
/// The edges of balance know a plan's accelerations by the parabola through three configurations
/// (edge_moving_balance.h) and close it up to what tracking gives away. Its curve has slopes of its
/// own, and a plan's wrenches are those of its curve. What inverse dynamics asks of the base along
/// the curve and the wrenches leave over goes to them, as far as the judge would not let it pass: a
/// nine-tenth of what it allows stays, so that a plan that holds stays as it is. Of the rest, r
/// (6):
///
///   least sum (delta_k / s_k)^2   with   A delta = r:   delta = S^2 A^T (A S^2 A^T)^+ r
///
/// A (6, components) is what they do to the base, and s_k the force of the contact [N], for moments
/// times 0.03 m: what bears nothing gets nothing, and what bears much a small share of it.

#include <locograph/check/motion.h>
#include <locograph/planners/plan/slope_limits.h>

namespace locograph {

/// Changes the wrenches of configurations that moved, or have a neighbour that did; those of others
/// stay as they are. Where the curve's acceleration jumps, the nearest between both sides counts,
/// as the judge has it. Plans of stances stay as they are. before: the plan's motion before, with
/// the same times. range: of the configurations that are looked at.
void carry_wrenches(const Motion& before, const Plan& plan, Graph& graph, const PlanRange& range);
void carry_wrenches(const Motion& before, const Plan& plan, Graph& graph);  ///< of all
/// The same of every configuration in the range, also where only times have changed.
void balance_wrenches(const Plan& plan, Graph& graph, const PlanRange& range);

}  // namespace locograph
