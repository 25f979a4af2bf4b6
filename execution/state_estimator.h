#pragma once
/// Where a robot is and how it moves, from what it has on board: joint encoders, an inertial
/// measurement unit in its base, and sensors of how hard its end effectors are pressed.
///
///     StateEstimator estimator(robot, effectors, start, 0.001);
///     estimator.update(readings, player.contacts());
///     controller.torques(estimator.configuration(), estimator.velocity(), player.reference(),
///                        player.contacts());
///
/// Joints, attitude and angular velocity are taken as they are read. The base moves so that what
/// bears does not slip: with v the velocity of the base's origin, J' the rest of the Jacobian of an
/// end effector's point and s its velocity where balls and wheels roll (w x r n),
///
///   v = mean of  s - J' (w_base, joints),
///
/// weighted by how hard each is pressed, those less that do not agree with the others. Its place is
/// the integral of v, drawn to where the contacts are that bear: at the start where the
/// configuration has them that the robot is thought to begin in, later where they were when they
/// were first pressed, always at the height of what they touch, and rolled on where they are balls
/// or wheels.
///
/// Without anything that bears the velocity stays. update() does not allocate. Keeps a pointer to
/// the robot, which must outlive it, as must contacts until the next update.

#include <locograph/execution/torque_controller.h>
#include <locograph/robots/robot_state.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace locograph {

struct SensorReadings {
  Eigen::VectorXd joints, joint_velocities;                      ///< of the active joints
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< world from base
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();    ///< base frame [rad/s]
  std::vector<double> pressing_N;                                ///< of each end effector
};

/// Throws Error naming the robot.
void require_floating_base(const Robot& robot);

class StateEstimator {
 public:
  /// start: the configuration that the robot is thought to begin in, at rest. Throws Error as
  /// require_floating_base() does.
  StateEstimator(const Robot& robot, std::span<const EndEffector> effectors,
                 const Eigen::VectorXd& start, double cycle_s);

  /// One cycle on. contacts: one for each end effector.
  void update(const SensorReadings& readings, std::span<const ContactCommand> contacts);

  const Eigen::VectorXd& configuration() const { return configuration_; }
  const Eigen::VectorXd& velocity() const { return velocity_; }

 private:
  struct Support {
    int link = -1;
    const Contact* contact = nullptr;  ///< that it has been pressed on so far
    bool since_start = false;          ///< held then, and not pressed yet
    double weight = 0.0;
    Eigen::Vector3d centre, rolls;  ///< where its point is; the velocity that it has if it rolls
    Eigen::Vector3d moves;          ///< its velocity if the base's origin stood still
    Eigen::Vector3d anchor;         ///< where its point should be
  };

  void look(const SensorReadings& readings, std::span<const ContactCommand> contacts);
  void find_velocity();
  void find_place();

  const std::span<const EndEffector> effectors_;
  const double cycle_s_, pressed_N_;
  RobotState state_;
  std::vector<Support> supports_;
  Eigen::VectorXd configuration_, velocity_;
  Eigen::Vector3d moves_ = Eigen::Vector3d::Zero();  ///< of the base's origin, in the world
  Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian_;
  bool started_ = false;
};

}  // namespace locograph
