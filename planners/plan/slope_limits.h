#pragma once
/// Slopes for a plan that is being changed: wheels roll and joints stay within their limits between
/// configurations, too.
///
///     Eigen::VectorXd slope = careful_slope(robot, motion, 7);
///     locograph::keep_within_limits(robot, q, 0.8, slope);
///     const Motion before = motion_of_slopes(graph, plan);
///     carry_slopes(before, plan, graph);             // after configurations have moved
///
/// Where two steps a and b (rates, tangents) point to different sides, the rule of the curve
/// (check/motion_curve.h) rounds the corner, and wheels that roll on both straight steps slip on
/// the round one. So its slope is scaled, all coordinates alike, by 1 - |b/|b| - a/|a|| / 2, and
/// down to 3 min(|a|, |b|), so that no step is passed and come back to: with slope 0 a step is
/// straight.
///
/// A cubic of duration h from one configuration to the next, r_0 and r_1 away from a limit, does
/// not pass it where its slope towards the limit is at most 3 r_0 / h at the beginning, and its
/// slope away from it at most 3 r_1 / h at the end: of the Hermite basis, h_10 <= h_00 / 3 and
/// -h_11 <= h_01 / 3 on [0, 1].

#include <locograph/check/motion.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/robots/robot.h>

#include <Eigen/Core>

namespace locograph {

/// Configurations of a plan, the last one included.
struct PlanRange {
  int first = 0, last = 0;
};

/// The slope at a vertex, neither first nor last, whatever slope the motion has there.
Eigen::VectorXd careful_slope(const Robot& robot, const Motion& motion, int vertex);

/// The motion that the slopes of a plan were made for: the plan as it is, or the one that its
/// EDGE_PLAN_TRACKINGs hold to, whichever they are nearer to by the rule of the curve. The latter
/// is so where configurations were disturbed and slopes were not. All with the slopes of the plan.
Motion motion_of_slopes(const Graph& graph, const Plan& plan);

/// Whether configuration i of a plan or one beside it is elsewhere than in the plan's motion
/// before, by more than 1e-9 m or rad.
bool moved_around(const Motion& before, const Plan& plan, const Graph& graph, int i);

/// Gives a plan whose configurations were moved the slopes that go with them: at each configuration
/// that moved, or has a neighbour that did, what a stored slope was away from the rule of the curve
/// it stays away, within limits of joints. A configuration at rest stays at rest, unless it is to
/// move, as do both ends.
/// Slopes by the rule follow by themselves. before: the plan's motion before, with the same times.
/// range: of the configurations that are looked at.
enum class Rests { kStay, kMove };
void carry_slopes(const Motion& before, const Plan& plan, Graph& graph, const PlanRange& range,
                  Rests rests = Rests::kStay);
void carry_slopes(const Motion& before, const Plan& plan, Graph& graph);  ///< of all

/// Slows joints of a configuration within limits. slope as Motion::slopes; step_s > 0 is the longer
/// one of the steps on both sides. A joint that is at its limit, or beyond it, does not move.
void keep_within_limits(const Robot& robot, const Eigen::VectorXd& configuration, double step_s,
                        Eigen::VectorXd& slope);

}  // namespace locograph
