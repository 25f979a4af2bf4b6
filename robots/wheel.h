#pragma once
/// A wheel of a robot: the disc that touches, the joint that turns it and the link that carries it.
///
///     const Wheel wheel = wheel_of(robot, contact.effector);
///     const WheelPose pose(state, wheel);
///     const double height = pose.centre.z() - wheel.radius_m;      // upright, above z = 0
///
/// Everything is fixed in the carrier: where the disc is and how its axle lies does not change as
/// the wheel turns. What steers a wheel is whatever turns its carrier.

#include <locograph/robots/contact.h>
#include <locograph/robots/robot_state.h>

#include <string>

namespace locograph {

struct Wheel {
  std::string name;  ///< of the contact
  double radius_m = 0.0;
  int link = -1;     ///< that turns
  int carrier = -1;  ///< that bears it
  int joint = -1;    ///< active joint between them, -1: frozen
  Eigen::Vector3d axle_in_carrier = Eigen::Vector3d::UnitY();  ///< unit; joints turn about it
  Eigen::Vector3d centre_in_carrier = Eigen::Vector3d::Zero();
  /// Unit, normal to the axle: its angle about the axle is the carrier's pitch.
  Eigen::Vector3d upright_in_carrier = Eigen::Vector3d::UnitZ();
};

/// Throws Error for an end effector that is no sound wheel (contact.h).
Wheel wheel_of(const Robot& robot, const EndEffector& effector);

/// Where a wheel is; world frame.
struct WheelPose {
  Eigen::Vector3d centre, axle;

  WheelPose(const RobotState& state, const Wheel& wheel)
      : centre(state.world_from_link(wheel.carrier) * wheel.centre_in_carrier),
        axle(state.world_from_link(wheel.carrier).linear() * wheel.axle_in_carrier) {}

  /// Unit vector along which an upright wheel rolls forward on a plane; shorter when it is tilted.
  Eigen::Vector3d heading(const Eigen::Vector3d& normal) const { return axle.cross(normal); }
};

/// The angle of the wheel's `upright_in_carrier` from the normal of a plane, about the axle [rad].
double carrier_pitch(const RobotState& state, const Wheel& wheel, const Eigen::Vector3d& normal);

/// Where the joint of a wheel is once its carrier has pitched, in carrier_pitch() [rad], if the
/// wheel has not turned on the ground: what the carrier pitches, the joint turns back.
double held_wheel_joint(double joint_before, double pitch_before, double pitch_now);

/// The point of the disc that is farthest against the normal.
Eigen::Vector3d lowest_point(const WheelPose& pose, double radius_m, const Eigen::Vector3d& normal);

}  // namespace locograph
