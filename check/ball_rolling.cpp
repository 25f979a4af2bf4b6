#include <locograph/check/ball_rolling.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

constexpr double kCorrection_m = 1e-7;
constexpr int kMostHalvings = 12;

/// Means of cos and sin over the angles from 0 to `angle`.
Eigen::Vector2d mean_direction(double angle) {
  if (std::abs(angle) < 1e-4) return {1.0 - angle * angle / 6.0, 0.5 * angle};
  return {std::sin(angle) / angle, (1.0 - std::cos(angle)) / angle};
}

}  // namespace

SkinStep skin_step(const JudgedContact& ball, const Eigen::Isometry3d& from,
                   const Eigen::Isometry3d& to) {
  const EndEffector& effector = ball.contact.effector;
  const double radius = effector.radius_m;
  const Eigen::Vector3d centre = from * effector.point, moved = to * effector.point - centre;
  const Eigen::AngleAxisd turned(Eigen::Matrix3d(to.linear() * from.linear().transpose()));
  const Eigen::Vector3d turn = turned.angle() * turned.axis();
  if (!ball.rolls_round) {
    const Eigen::Vector3d& n = ball.normal;
    const Eigen::Vector3d along = moved - n * n.dot(moved);
    return {along - radius * turn.cross(n), along.norm()};
  }
  const Bar& bar = *ball.rolls_round;
  const Eigen::Vector3d axis = (bar.to - bar.from).normalized();
  const auto out = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
    const Eigen::Vector3d off = point - bar.from;
    return off - axis * axis.dot(off);
  };
  const Eigen::Vector3d before = out(centre), after = out(centre + moved);
  const double phi = std::atan2(axis.dot(before.cross(after)), before.dot(after));
  const Eigen::Vector3d n = before.normalized(), e = axis.cross(n);
  const Eigen::Vector2d mean = mean_direction(phi);
  const Eigen::Vector3d mean_e = mean.x() * e - mean.y() * n;
  const double along = axis.dot(moved);
  return {{along + radius * turn.dot(mean_e),
           (bar.radius_m + radius) * phi - radius * turn.dot(axis), 0.0},
          std::hypot(along, bar.radius_m * phi)};
}

void SkinPath::add(const SkinStep& step) {
  slip_ += step.slip;
  way_m_ += step.way_m;
  most_m_ = std::max(most_m_, slip_.norm());
}

void SkinPath::add(const JudgedContact& ball, const Part& part, const PoseAt& pose_at) {
  add(ball, part, pose_at, 0);
}

void SkinPath::add(const JudgedContact& ball, const Part& part, const PoseAt& pose_at,
                   int halvings) {
  const auto& [fractions, poses] = part;
  SkinStep first = skin_step(ball, poses[0], poses[1]);
  SkinStep second = skin_step(ball, poses[1], poses[2]);
  const Eigen::Vector3d correction =
      (first.slip + second.slip - skin_step(ball, poses[0], poses[2]).slip) / 3.0;
  if (correction.norm() > kCorrection_m && halvings < kMostHalvings) {
    for (const std::size_t half : {std::size_t{0}, std::size_t{1}}) {
      const double middle = 0.5 * (fractions[half] + fractions[half + 1]);
      add(ball,
          {{fractions[half], middle, fractions[half + 1]},
           {poses[half], pose_at(middle), poses[half + 1]}},
          pose_at, halvings + 1);
    }
    return;
  }
  first.slip += 0.5 * correction;
  second.slip += 0.5 * correction;
  add(first);
  add(second);
}

}  // namespace locograph
