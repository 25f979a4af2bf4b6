#pragma once
/// How far a robot is from obstacles that move, appear or vanish, as its spheres are: what the
/// window's edges see, which is more than the judge does.
///
///     ChangingObstacles obstacles(*robot, world);
///     const std::vector<Eigen::Vector3d> centres = obstacles.centres(planned.front());
///     const bool is_free = obstacles.keep_away(centres, 12.5, 0.02);

#include <locograph/plugins/configuration/robot_parameters.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/world.h>

#include <Eigen/Core>
#include <vector>

namespace locograph {

class ChangingObstacles {
 public:
  /// Robot and world must outlive it.
  ChangingObstacles(const RobotParameter& robot, const World& world);

  bool any() const { return !obstacles_.empty(); }
  /// Of the robot's spheres at a configuration [m, world].
  std::vector<Eigen::Vector3d> centres(const Eigen::VectorXd& configuration);
  /// Whether spheres with these centres are further away than apart_m from all that is there then.
  bool keep_away(const std::vector<Eigen::Vector3d>& centres, double time_s, double apart_m) const;

 private:
  const RobotParameter& robot_;
  std::vector<const Obstacle*> obstacles_;
  RobotState state_;
};

}  // namespace locograph
