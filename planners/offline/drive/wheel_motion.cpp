#include <locograph/planners/offline/drive/wheel_motion.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace locograph {
namespace {

/// Cosine of the largest angle between a steering axis and the normal of the plane.
constexpr double kUpright = 0.95;
constexpr double kRoom_rad = 0.02;

}  // namespace

WheelMotion::WheelMotion(const Robot& robot, const Stance& stance)
    : robot_(robot),
      wheels_(standing_wheels(robot, stance)),
      state_(robot),
      pitch_before_(wheels_.size()) {
  for (const auto& standing : wheels_) before_.emplace_back(state_, standing.wheel);
}

WheelPose WheelMotion::pose(const Eigen::VectorXd& q, int number) {
  state_.update(q.data());
  return {state_, wheel(number).wheel};
}

int WheelMotion::steering_joint(int number) const {
  const int carrier = wheel(number).wheel.carrier;
  const int above = robot_.links()[static_cast<std::size_t>(carrier)].parent_joint;
  return above < 0 ? -1 : robot_.joints()[static_cast<std::size_t>(above)].index;
}

bool WheelMotion::steer(Eigen::VectorXd& q, int number, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d& normal = wheel(number).normal;
  const Eigen::Vector3d heading = pose(q, number).heading(normal);
  const double pi = std::numbers::pi;
  // The angle from the heading to the direction, about the normal.
  const double turn = std::atan2(normal.dot(heading.cross(direction)), heading.dot(direction));
  const double other = turn - std::copysign(pi, turn);
  const int active = steering_joint(number);
  if (active < 0) return std::min(std::abs(turn), std::abs(other)) < 1e-9;
  const double upright = state_.joint_axis(robot_.axes_of(active).front()).dot(normal);
  if (std::abs(upright) < kUpright) return false;
  const Joint& limits = robot_.active_joint(active);
  double& joint = q[robot_.base_configuration_size() + active];
  const double smaller = std::abs(turn) <= std::abs(other) ? turn : other;
  // With some room to its limits if there is a way: whatever closes contacts after that moves it.
  for (const double room_rad : {kRoom_rad, 0.0}) {
    for (const double option : {smaller, smaller == turn ? other : turn}) {
      const double position = joint + option * std::copysign(1.0, upright);
      if (position < limits.lower + room_rad || position > limits.upper - room_rad) continue;
      joint = position;
      return true;
    }
  }
  return false;
}

void WheelMotion::drive(const Eigen::Ref<const Eigen::VectorXd>& from, const Eigen::Vector3d& way,
                        double turn, Eigen::VectorXd& to) {
  constexpr double kLeast_m = 1e-3;
  if (way.norm() > kLeast_m) {
    for (int w = 0; w < wheels(); ++w) {
      const Eigen::Vector3d arm = pose(to, w).centre - to.head<3>();
      steer(to, w, way + turn * Eigen::Vector3d::UnitZ().cross(arm));
    }
  }
  roll(from, to);
}

void WheelMotion::hold(const Eigen::Ref<const Eigen::VectorXd>& from,
                       Eigen::Ref<Eigen::VectorXd> to) {
  const auto pitch = [this](int w) {
    return carrier_pitch(state_, wheel(w).wheel, wheel(w).normal);
  };
  const int base = robot_.base_configuration_size();
  state_.update(from.data());
  for (int w = 0; w < wheels(); ++w) pitch_before_[static_cast<std::size_t>(w)] = pitch(w);
  state_.update(to.data());
  for (int w = 0; w < wheels(); ++w) {
    const int joint = wheel(w).wheel.joint;
    if (joint < 0 || !wheel(w).locked) continue;
    const double before = pitch_before_[static_cast<std::size_t>(w)];
    to[base + joint] = held_wheel_joint(from[base + joint], before, pitch(w));
  }
}

void WheelMotion::roll(const Eigen::Ref<const Eigen::VectorXd>& from,
                       Eigen::Ref<Eigen::VectorXd> to) {
  const int base = robot_.base_configuration_size();
  state_.update(from.data());
  for (int w = 0; w < wheels(); ++w) {
    before_[static_cast<std::size_t>(w)] = WheelPose(state_, wheel(w).wheel);
  }
  state_.update(to.data());
  for (int w = 0; w < wheels(); ++w) {
    const StanceParameter::StandingWheel& standing = wheel(w);
    const int joint = standing.wheel.joint;
    if (joint < 0) continue;
    to[base + joint] = from[base + joint];
    if (standing.locked) continue;
    const WheelPose& before = before_[static_cast<std::size_t>(w)];
    const WheelPose after(state_, standing.wheel);
    const Eigen::Vector3d mean =
        (before.heading(standing.normal) + after.heading(standing.normal)).stableNormalized();
    to[base + joint] += (after.centre - before.centre).dot(mean) / standing.wheel.radius_m;
  }
}

}  // namespace locograph
