#pragma once
/// How a robot stands on a floor, where nobody has said: its legs bent a little, its base upright.
///
///     auto robot = std::make_shared<const RobotParameter>(urdf, srdf, RobotOptions());
///     const StandingStart start = standing_start(robot, proposed_effectors(*robot->robot), 0.7);
///     if (!start.answer.success()) std::cerr << start.answer.reason;
///
/// Near to how its legs are bent by themselves (world/bent_legs.h). The posture solver does the
/// rest: balance, distances, torques.

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

/// friction: of contacts. Throws Error for no end effector, and as PostureSolver does.
StandingStart standing_start(const std::shared_ptr<const RobotParameter>& robot,
                             std::vector<EndEffector> effectors, double friction,
                             const PostureOptions& options = {});

}  // namespace locograph
