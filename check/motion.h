#pragma once
/// A timed sequence of configurations that says where the robot stands, and the robot's link poses
/// anywhere along it.
///
///     locograph::Motion motion{.time_s = {0.0, 0.5}, .configurations = {q0, q1},
///                              .stances = {both_feet}, .stance_from = {0, 0}};
///     locograph::MotionSampler sampler(robot, motion);
///     std::vector<Eigen::Isometry3d> world_from_link;
///     sampler.link_poses(0, 0.5, world_from_link);  // half-way between vertices 0 and 1
///
/// A stance belongs to a step: stance_from[i] is held from configuration i to the next one, so that
/// configuration i is a transition when stance_from[i - 1] is another one, and has to be feasible
/// for both. stance_from of the last configuration is the stance the robot ends in.
///
/// Between two vertices the base position and the joints are linear, the base orientation turns at
/// constant rate about one axis, the short way round (slerp). A configuration is laid out as in
/// robot.h. A sampler keeps pointers to the robot and to the motion; one for each thread.

#include <locograph/robots/contact.h>
#include <locograph/robots/robot.h>
#include <locograph/robots/robot_state.h>

#include <Eigen/Geometry>
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
};

/// How much a configuration changes from one vertex to the next.
struct ConfigurationStep {
  double base_distance_m = 0.0;
  double base_angle_rad = 0.0;
  Eigen::VectorXd joints;  ///< change of each active joint, with its sign
};

ConfigurationStep configuration_step(const Robot& robot, const Eigen::VectorXd& from,
                                     const Eigen::VectorXd& to);

/// fraction in [0, 1]; the quaternions need not have norm 1, but must not be zero; out gets one of
/// norm 1.
void interpolate(const Robot& robot, const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                 double fraction, Eigen::VectorXd& out);

class MotionSampler {
 public:
  MotionSampler(const Robot& robot, const Motion& motion)
      : robot_(&robot), motion_(&motion), state_(robot) {}

  /// Poses at `fraction` of the way from vertex `vertex` to the next; at fraction 0 the next one
  /// is not read. Vertices must be finite and of the right size. The motion must not change.
  void link_poses(int vertex, double fraction, std::vector<Eigen::Isometry3d>& world_from_link);
  double time_s(int vertex, double fraction) const;
  /// Of the last link_poses().
  const RobotState& state() const { return state_; }
  const Eigen::VectorXd& configuration() const { return configuration_; }

 private:
  void move_to(int vertex, double fraction);

  const Robot* robot_;
  const Motion* motion_;
  int vertex_ = -1;  // where state_ is
  double fraction_ = 0.0;
  RobotState state_;
  Eigen::VectorXd configuration_;
};

}  // namespace locograph
