#pragma once
/// How far a robot is from obstacles that move, appear or vanish, as its spheres are: what the
/// window's edges see, which is more than the judge does.
///
///     ChangingObstacles obstacles(*robot, world);
///     const std::vector<Eigen::Vector3d> centres = obstacles.centres(planned.front());
///     const bool is_free = obstacles.keep_away(centres, 12.5, 0.02);

#include <locograph/check/motion.h>
#include <locograph/plugins/configuration/robot_parameters.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/world.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace locograph {

/// For so long a place of rest stays free if there is such a place, and so long a robot waits at
/// most, as long as where it stands is free.
constexpr double kStands_s = 10.0, kWaits_s = 20.0;

class ChangingObstacles {
 public:
  /// Robot and world must outlive it.
  ChangingObstacles(const RobotParameter& robot, const World& world);

  bool any() const { return !obstacles_.empty(); }
  /// Of the robot's spheres at a configuration [m, world].
  std::vector<Eigen::Vector3d> centres(const Eigen::VectorXd& configuration);
  /// Whether spheres with these centres are further away than apart_m from all that is there then.
  bool keep_away(const std::vector<Eigen::Vector3d>& centres, double time_s, double apart_m) const;
  /// The least time, in steps of 0.25 s, by which a motion has to begin later than at begin_s, to
  /// which its own times are added, so that it keeps 2 cm away. nullopt: that is more than
  /// kWaits_s, or its first configuration does not stay free until then.
  std::optional<double> free_after(const Motion& motion, double begin_s);
  /// Why the last free_after() gave none.
  std::string refusal() const;

 private:
  const RobotParameter& robot_;
  std::vector<const Obstacle*> obstacles_;
  RobotState state_;
  bool waits_ = true;  ///< where the robot would wait stayed free
};

}  // namespace locograph
