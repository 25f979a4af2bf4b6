#pragma once
/// How a robot stands on a floor, where nobody has said: its legs bent a little, its base upright.
///
///     auto robot = std::make_shared<const RobotParameter>(urdf, srdf, RobotOptions());
///     const StandingStart start = standing_start(robot, proposed_effectors(*robot->robot), 0.7);
///     if (!start.answer.success()) std::cerr << start.answer.reason;
///
/// Each leg is bent by itself, the base held: soles level and ahead as they are in the neutral
/// configuration, points below the first joint of their leg, neither further to the side of it than
/// 15 % of the stretched leg (wheels stay), all moved so that the centre of mass
/// is over their middle, and at the height at which the leg that is bent least is shorter than
/// stretched by 6 %, where there are more than two by 20 %. Where limits are one-sided, as those of
/// knees and elbows, a joint begins bent to the side that has more room, so that knees bend the
/// right way; legs whose limits say nothing bend either way. The posture solver does the rest:
/// balance, distances, torques.

#include <locograph/planners/posture/posture_solver.h>
#include <locograph/robots/contact.h>

#include <memory>
#include <vector>

namespace locograph {

struct StandingStart {
  Stance stance;         ///< all end effectors on the plane z = 0, wheels locked
  Eigen::VectorXd bent;  ///< what the posture is near to
  PostureResult answer;
};

/// The legs alone, without balance; the base where its lowest contact is on z = 0. Deterministic.
Eigen::VectorXd bent_legs(const Robot& robot, const std::vector<EndEffector>& effectors);

/// friction: of contacts. Throws Error for no end effector, and as PostureSolver does.
StandingStart standing_start(const std::shared_ptr<const RobotParameter>& robot,
                             std::vector<EndEffector> effectors, double friction,
                             const PostureOptions& options = {});

}  // namespace locograph
