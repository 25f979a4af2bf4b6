#include <locograph/common/error.h>
#include <locograph/robots/wheel.h>

#include <cmath>
#include <numbers>

namespace locograph {

Wheel wheel_of(const Robot& robot, const EndEffector& effector) {
  if (effector.kind != ContactKind::kWheel) {
    throw Error("a " + contact_kind_name(effector.kind) + " where a wheel is asked for", "a wheel");
  }
  require_sound_effector(robot, effector);
  Wheel wheel;
  wheel.name = effector.name.empty() ? effector.link : effector.name;
  wheel.radius_m = effector.radius_m;
  wheel.link = robot.link_index(effector.link);
  const Link& link = robot.links()[static_cast<std::size_t>(wheel.link)];
  const Joint& joint = robot.joints()[static_cast<std::size_t>(link.parent_joint)];
  wheel.carrier = joint.parent_link;
  wheel.joint = joint.index;
  wheel.axle_in_carrier = joint.parent_from_joint.linear() * joint.axis;
  // On the axle, as the effector is sound: turning does not move it.
  wheel.centre_in_carrier = joint.parent_from_joint * (joint.axis * joint.axis.dot(effector.point));
  // The carrier's axis that is most nearly normal to the axle, made normal to it.
  int axis = 0;
  wheel.axle_in_carrier.cwiseAbs().minCoeff(&axis);
  Eigen::Vector3d upright = Eigen::Vector3d::Unit(axis);
  upright -= wheel.axle_in_carrier * wheel.axle_in_carrier.dot(upright);
  wheel.upright_in_carrier = upright.normalized();
  return wheel;
}

double carrier_pitch(const RobotState& state, const Wheel& wheel, const Eigen::Vector3d& normal) {
  const Eigen::Matrix3d& carrier = state.world_from_link(wheel.carrier).linear();
  const Eigen::Vector3d upright = carrier * wheel.upright_in_carrier;
  const Eigen::Vector3d axle = carrier * wheel.axle_in_carrier;
  return std::atan2(normal.cross(upright).dot(axle), normal.dot(upright));
}

double held_wheel_joint(double joint_before, double pitch_before, double pitch_now) {
  return joint_before - std::remainder(pitch_now - pitch_before, 2.0 * std::numbers::pi);
}

Eigen::Vector3d lowest_point(const WheelPose& pose, double radius_m,
                             const Eigen::Vector3d& normal) {
  const Eigen::Vector3d up = normal.stableNormalized();
  const Eigen::Vector3d down = pose.axle * pose.axle.dot(up) - up;
  const double length = down.norm();
  // A disc that lies flat touches everywhere.
  return length > 1e-6 ? Eigen::Vector3d(pose.centre + radius_m / length * down) : pose.centre;
}

}  // namespace locograph
