#include <locograph/planners/plan/wheel_motion.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace locograph {
namespace {

/// Cosine of the largest angle between a steering axis and the vertical.
constexpr double kUpright = 0.95;

}  // namespace

WheelMotion::WheelMotion(const Robot& robot, const WheelsParameter& wheels)
    : robot_(robot), wheels_(wheels), state_(robot), before_(wheels.wheels.size()) {}

WheelMotion::Pose WheelMotion::current(const Wheel& wheel) const {
  const Eigen::Isometry3d& carrier = state_.world_from_link(wheel.carrier);
  const Eigen::Vector3d axle = carrier.linear() * wheel.axle_in_carrier;
  return {carrier * wheel.centre_in_carrier, axle.cross(Eigen::Vector3d::UnitZ())};
}

WheelMotion::Pose WheelMotion::pose(const Eigen::VectorXd& q, int wheel) {
  state_.update(q.data());
  return current(wheels_.wheels[wheel]);
}

bool WheelMotion::steer(Eigen::VectorXd& q, int number, const Eigen::Vector2d& direction) {
  const Eigen::Vector3d heading = pose(q, number).heading;
  const double pi = std::numbers::pi;
  const double turn = std::remainder(
      std::atan2(direction.y(), direction.x()) - std::atan2(heading.y(), heading.x()), 2.0 * pi);
  const double other = turn - std::copysign(pi, turn);
  const int above = robot_.links()[wheels_.wheels[number].carrier].parent_joint;
  const int active = above < 0 ? -1 : robot_.joints()[above].index;
  if (active < 0) return std::min(std::abs(turn), std::abs(other)) < 1e-9;
  const double upright = state_.joint_axis(active).z();
  if (std::abs(upright) < kUpright) return false;
  const Joint& limits = robot_.active_joint(active);
  double& joint = q[robot_.base_configuration_size() + active];
  const double smaller = std::abs(turn) <= std::abs(other) ? turn : other;
  for (const double option : {smaller, smaller == turn ? other : turn}) {
    const double position = joint + option * std::copysign(1.0, upright);
    if (position < limits.lower || position > limits.upper) continue;
    joint = position;
    return true;
  }
  return false;
}

void WheelMotion::roll(const Eigen::VectorXd& from, Eigen::VectorXd& to) {
  const int base = robot_.base_configuration_size();
  state_.update(from.data());
  for (std::size_t w = 0; w < before_.size(); ++w) before_[w] = current(wheels_.wheels[w]);
  state_.update(to.data());
  for (std::size_t w = 0; w < before_.size(); ++w) {
    const Wheel& wheel = wheels_.wheels[w];
    if (wheel.joint < 0) continue;
    const Pose after = current(wheel);
    const Eigen::Vector3d mean = 0.5 * (before_[w].heading + after.heading);
    to[base + wheel.joint] =
        from[base + wheel.joint] + (after.centre - before_[w].centre).dot(mean) / wheel.radius_m;
  }
}

}  // namespace locograph
