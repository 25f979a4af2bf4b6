#pragma once
/// How a robot's legs are bent as it stands, by its shapes and limits alone.
///
///     const Eigen::VectorXd q = bent_legs(robot, proposed_effectors(robot));
///
/// Each leg is bent by itself, the base held: soles level and ahead as they are in the neutral
/// configuration, points below the first joint of their leg, neither further to the side of it than
/// 15 % of the stretched leg (wheels stay), all moved so that the centre of mass
/// is over their middle, and at the height at which the leg that is bent least is shorter than
/// stretched by 6 %, where there are more than two by 20 %. Where limits are one-sided, as those of
/// knees and elbows, a joint begins bent to the side that has more room, so that knees bend the
/// right way; legs whose limits say nothing bend either way.

#include <locograph/robots/contact.h>
#include <locograph/robots/robot.h>

#include <vector>

namespace locograph {

/// Without balance and torques; the base where the lowest contact is on z = 0. Deterministic.
/// Throws Error for an end effector on a link that does not move.
Eigen::VectorXd bent_legs(const Robot& robot, const std::vector<EndEffector>& effectors);

}  // namespace locograph
