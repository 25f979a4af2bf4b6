#pragma once
/// A way of a robot on wheels whose base is placed already: its wheels are put on the ground,
/// steered along it and turned.
///
///     DrivenWheels wheels(robot, stance);
///     if (wheels.drive(way)) motion.configurations = way;

#include <locograph/check/motion.h>
#include <locograph/planners/offline/drive/wheel_motion.h>
#include <locograph/planners/posture/contact_projection.h>
#include <locograph/planners/task/task.h>

#include <Eigen/Core>
#include <vector>

namespace locograph {

/// Of the base while it speeds up, at most.
inline constexpr double kDriveAcceleration_m_s2 = 0.3;

class DrivenWheels {
 public:
  /// Robot and stance must outlive it. Throws Error as WheelMotion does.
  DrivenWheels(const Robot& robot, const Stance& stance);

  /// Whether all wheels that roll can be steered.
  bool can_steer(const Eigen::VectorXd& q);
  /// Of wheels that have one.
  const std::vector<int>& steering_joints() const { return steering_joints_; }
  /// A tangent without what steers and turns wheels.
  void leave_out(Eigen::VectorXd& tangent) const;
  /// The wheels are as they are in the first configuration. Whether they can be put on the ground.
  bool drive(std::vector<Eigen::VectorXd>& way);
  /// Turns the wheels of a configuration as far as they roll from another one.
  void roll(const Eigen::VectorXd& from, Eigen::VectorXd& to) { motion_.roll(from, to); }
  /// The first configuration with its wheels steered along the way; false: it cannot be done.
  bool steer_along(const std::vector<Eigen::VectorXd>& way, Eigen::VectorXd& steered);
  /// The wheels are steered where the robot stands, by a share of what they are in the other
  /// configuration.
  bool steer_standing(const Eigen::VectorXd& stands, const Eigen::VectorXd& steered, double share,
                      Eigen::VectorXd& q);
  /// How far a wheel is steered between the two at most [rad].
  double largest_turn(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const;
  /// Of the centre of a wheel, from one configuration to another [m].
  double longest_way(const Eigen::VectorXd& from, const Eigen::VectorXd& to);
  /// Wheels that are turned half round on the way, as a joint has come to its limit, are steered so
  /// from the start.
  void steer_other_way(const std::vector<Eigen::VectorXd>& way, Eigen::VectorXd& steered) const;
  /// The joints that steer and turn wheels are in `to` as they are in `from`.
  void keep(const Eigen::VectorXd& from, Eigen::VectorXd& to) const;

 private:
  bool steer(Eigen::VectorXd& q, const std::vector<Eigen::Vector3d>& from,
             const std::vector<Eigen::Vector3d>& to);
  bool put_down(Eigen::VectorXd& q);

  const Robot& robot_;
  const std::vector<Contact>& contacts_;
  WheelMotion motion_;
  std::vector<int> steering_joints_, turning_joints_;
  RobotState state_;
  ContactProjection closed_;
};

/// How fast a robot drives that is so far from where it was, or will be, at rest: of its speed, as
/// the root of the way, and never so slow that it stands.
double share_of_speed(double way_m, double speed_m_s);

/// How long a step of a plan takes, in the middle of all that move.
double usual_step_s(const Motion& planned);

/// How long wheels steer from one configuration to another, from rest to rest, at half of the
/// velocity that joints allow at most.
double steering_s(const Task& task, const Eigen::VectorXd& from, const Eigen::VectorXd& steered);

}  // namespace locograph
