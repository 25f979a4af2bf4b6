#pragma once
/// A timed sequence of configurations that says where the robot stands.
///
///     locograph::Motion motion{.time_s = {0.0, 0.5}, .configurations = {q0, q1},
///                              .stances = {both_feet}, .stance_from = {0, 0}};
///     locograph::MotionCurve curve(robot, motion);   // what lies in between
///
/// A stance belongs to a step: stance_from[i] is held from configuration i to the next one, so that
/// configuration i is a transition when stance_from[i - 1] is another one, and has to be feasible
/// for both. stance_from of the last configuration is the stance the robot ends in.
///
/// A motion defines one curve, see motion_curve.h. A configuration is laid out as in robot.h.

#include <locograph/robots/contact.h>

#include <Eigen/Core>
#include <vector>

namespace locograph {

struct Motion {
  std::vector<double> time_s;                   ///< one per configuration
  std::vector<Eigen::VectorXd> configurations;  ///< the vertices
  std::vector<Stance> stances;
  std::vector<int> stance_from;  ///< one per configuration, into stances; -1: not known
  /// The configurations are transitions of a plan of stances: nothing moves between them, times
  /// mean nothing, and wheels stand still.
  bool stances_only = false;
  /// Slopes of the curve, one per configuration, or none at all; an empty one: by the rule of
  /// motion_curve.h. In the order of the tangent: of the base's position in the world [m/s], its
  /// angular velocity along its own axes [rad/s], rates of the joints.
  std::vector<Eigen::VectorXd> slopes = {};
  /// What bears the robot, one per configuration, at the contacts of the stance that it is left in;
  /// an empty one: not known; or none at all. Between configurations forces go over linearly; a
  /// contact that closes carries nothing yet, one that opens nothing more. Balance is judged
  /// without them.
  std::vector<StanceWrenches> wrenches = {};
};

}  // namespace locograph
