#pragma once
/// A timed sequence of configurations, and the robot's link poses anywhere along it.
///
///     locograph::Motion motion{times, configurations, {{robot.link_index("wheel_1"), 0.078}}};
///     locograph::MotionSampler sampler(robot, motion);
///     std::vector<Eigen::Isometry3d> world_from_link;
///     sampler.link_poses(3, 0.5, world_from_link);  // half-way between vertices 3 and 4
///
/// Between two vertices the base position and the joints are linear, the base orientation turns at
/// constant rate about one axis, the short way round (slerp). A configuration is laid out as in
/// robot.h. Keeps pointers to the robot and to the motion; one sampler per thread.

#include <locograph/plugins/static_balance/contact_parameter.h>
#include <locograph/robots/robot.h>
#include <locograph/robots/robot_state.h>

#include <Eigen/Geometry>
#include <vector>

namespace locograph {

/// A disc about the axis of the joint above `link`; its centre is the origin of the link.
struct RollingWheel {
  int link = -1;
  double radius_m = 0.0;
};

struct Motion {
  std::vector<double> time_s;                   ///< one per configuration
  std::vector<Eigen::VectorXd> configurations;  ///< the vertices
  std::vector<RollingWheel> wheels;             ///< that roll on the ground all the time
  /// What each vertex stands on, one list for each configuration; an empty list, and no lists at
  /// all: not known.
  std::vector<std::vector<ContactDescription>> contacts = {};
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
  /// is not read. Vertices must be finite and of the right size.
  void link_poses(int vertex, double fraction, std::vector<Eigen::Isometry3d>& world_from_link);
  double time_s(int vertex, double fraction) const;

 private:
  const Robot* robot_;
  const Motion* motion_;
  RobotState state_;
  Eigen::VectorXd configuration_;
};

}  // namespace locograph
