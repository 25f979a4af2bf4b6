#include <locograph/planners/online/driven_way.h>

#include <algorithm>
#include <cmath>

namespace locograph {

DrivenWheels::DrivenWheels(const Robot& robot, const Stance& stance)
    : robot_(robot),
      contacts_(stance.contacts),
      motion_(robot, stance),
      state_(robot),
      closed_(robot) {
  for (int w = 0; w < motion_.wheels(); ++w) {
    const int steering = motion_.steering_joint(w), turning = motion_.wheel(w).wheel.joint;
    if (steering >= 0) steering_joints_.push_back(steering);
    if (turning >= 0) turning_joints_.push_back(turning);
  }
}

bool DrivenWheels::can_steer(const Eigen::VectorXd& q) {
  Eigen::VectorXd steered = q;
  for (int w = 0; w < motion_.wheels(); ++w) {
    const StanceParameter::StandingWheel& standing = motion_.wheel(w);
    if (standing.locked) continue;
    if (motion_.steering_joint(w) < 0) return false;
    if (!motion_.steer(steered, w, motion_.pose(q, w).heading(standing.normal))) return false;
  }
  return true;
}

void DrivenWheels::leave_out(Eigen::VectorXd& tangent) const {
  const int base = robot_.base_tangent_size();
  for (const int joint : steering_joints_) tangent[base + joint] = 0.0;
  for (const int joint : turning_joints_) tangent[base + joint] = 0.0;
}

bool DrivenWheels::drive(std::vector<Eigen::VectorXd>& way) {
  for (std::size_t k = 1; k < way.size(); ++k) {
    if (!put_down(way[k])) return false;
  }
  // Steering hardly moves a wheel's centre.
  std::vector<std::vector<Eigen::Vector3d>> centres;
  for (const Eigen::VectorXd& q : way) {
    std::vector<Eigen::Vector3d>& here = centres.emplace_back();
    for (int w = 0; w < motion_.wheels(); ++w) here.push_back(motion_.pose(q, w).centre);
  }
  for (std::size_t k = 1; k < way.size(); ++k) {
    if (!steer(way[k], centres[k - 1], centres[std::min(k + 1, way.size() - 1)])) return false;
    motion_.roll(way[k - 1], way[k]);
  }
  return true;
}

bool DrivenWheels::steer_along(const std::vector<Eigen::VectorXd>& way, Eigen::VectorXd& steered) {
  std::vector<Eigen::Vector3d> from, to;
  for (int w = 0; w < motion_.wheels(); ++w) {
    from.push_back(motion_.pose(way[0], w).centre);
    to.push_back(motion_.pose(way[1], w).centre);
  }
  steered = way.front();
  if (!steer(steered, from, to)) return false;
  motion_.roll(way.front(), steered);
  return true;
}

bool DrivenWheels::steer_standing(const Eigen::VectorXd& stands, const Eigen::VectorXd& steered,
                                  double share, Eigen::VectorXd& q) {
  q = stands;
  for (const int joint : steering_joints_) {
    const int at = robot_.base_configuration_size() + joint;
    q[at] += share * (steered[at] - stands[at]);
  }
  std::vector<Contact> locked = contacts_;
  int wheel = 0;
  for (Contact& contact : locked) {
    if (contact.effector.kind != ContactKind::kWheel) continue;
    const StanceParameter::StandingWheel& standing = motion_.wheel(wheel);
    contact.locked = true;
    contact.position =
        lowest_point(motion_.pose(stands, wheel++), standing.wheel.radius_m, standing.normal);
  }
  state_.update(stands.data());
  closed_.set(locked, held_balls(state_, locked, [](const Contact&) { return true; }));
  return closed_.project(q);
}

double DrivenWheels::largest_turn(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
  double largest_rad = 0.0;
  for (const int joint : steering_joints_) {
    const int at = robot_.base_configuration_size() + joint;
    largest_rad = std::max(largest_rad, std::abs(to[at] - from[at]));
  }
  return largest_rad;
}

void DrivenWheels::steer_other_way(const std::vector<Eigen::VectorXd>& way,
                                   Eigen::VectorXd& steered) const {
  constexpr double kHalfRound_rad = 2.0;  // in a step: more than wheels are steered while they roll
  for (const int joint : steering_joints_) {
    const int at = robot_.base_configuration_size() + joint;
    const auto turned = std::ranges::adjacent_find(way, [at](const auto& q, const auto& next) {
      return std::abs(next[at] - q[at]) > kHalfRound_rad;
    });
    if (turned == way.end()) continue;
    steered[at] = (*std::next(turned))[at];
  }
}

double DrivenWheels::longest_way(const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
  double longest_m = 0.0;
  for (int w = 0; w < motion_.wheels(); ++w) {
    const Eigen::Vector3d way = motion_.pose(to, w).centre - motion_.pose(from, w).centre;
    longest_m = std::max(longest_m, way.norm());
  }
  return longest_m;
}

void DrivenWheels::keep(const Eigen::VectorXd& from, Eigen::VectorXd& to) const {
  const int base = robot_.base_configuration_size();
  for (const int joint : steering_joints_) to[base + joint] = from[base + joint];
  for (const int joint : turning_joints_) to[base + joint] = from[base + joint];
}

/// Steering axes are not quite upright: some times over.
bool DrivenWheels::steer(Eigen::VectorXd& q, const std::vector<Eigen::Vector3d>& from,
                         const std::vector<Eigen::Vector3d>& to) {
  constexpr int kTimes = 3;
  constexpr double kLeast_m = 1e-3;
  for (int time = 0; time < kTimes; ++time) {
    for (int w = 0; w < motion_.wheels(); ++w) {
      const auto k = static_cast<std::size_t>(w);
      const Eigen::Vector3d way = to[k] - from[k];
      if (way.norm() > kLeast_m) motion_.steer(q, w, way);
    }
    if (!put_down(q)) return false;
  }
  return true;
}

bool DrivenWheels::put_down(Eigen::VectorXd& q) {
  state_.update(q.data());
  closed_.set(contacts_, held_balls(state_, contacts_, [](const Contact&) { return true; }));
  return closed_.project(q);
}

double share_of_speed(double way_m, double speed_m_s) {
  constexpr double kLeast = 0.1;
  const double ramp_m = speed_m_s * speed_m_s / (2.0 * kDriveAcceleration_m_s2);
  return std::clamp(std::sqrt(way_m / ramp_m), kLeast, 1.0);
}

double usual_step_s(const Motion& planned) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < planned.time_s.size(); ++i) {
    if (planned.configurations[i] == planned.configurations[i - 1]) continue;
    steps_s.push_back(planned.time_s[i] - planned.time_s[i - 1]);
  }
  if (steps_s.empty()) return planned.time_s.back();
  std::ranges::sort(steps_s);
  return steps_s[steps_s.size() / 2];
}

double steering_s(const Task& task, const Eigen::VectorXd& from, const Eigen::VectorXd& steered) {
  constexpr double kAcceleration_rad_s2 = 5.0, kShareOfLimit = 0.8;
  const Robot& robot = *task.robot->robot;
  const double limit = task.check.joint_acceleration_rad_s2;
  const double acceleration =
      limit > 0.0 ? std::min(kAcceleration_rad_s2, kShareOfLimit * limit) : kAcceleration_rad_s2;
  double needs_s = 0.0;
  const int base = robot.base_configuration_size();
  for (int j = 0; j < robot.active_joint_count(); ++j) {
    const double moves = std::abs(steered[base + j] - from[base + j]);
    const double most = robot.active_joint(j).max_velocity;
    needs_s = std::max(needs_s, std::sqrt(6.0 * moves / acceleration));
    if (std::isfinite(most) && most > 0.0) needs_s = std::max(needs_s, 3.0 * moves / most);
  }
  return needs_s;
}

}  // namespace locograph
