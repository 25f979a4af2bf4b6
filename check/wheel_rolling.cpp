#include <locograph/check/limits.h>
#include <locograph/check/wheel_rolling.h>

#include <algorithm>
#include <cmath>

namespace locograph {

WheelStep wheel_step(const JudgedContact& wheel, std::span<const Eigen::Isometry3d> from,
                     std::span<const Eigen::Isometry3d> to) {
  const Eigen::Isometry3d &before = from[std::size_t(wheel.link)],
                          &after = to[std::size_t(wheel.link)];
  const EndEffector& effector = wheel.contact.effector;
  const Eigen::Vector3d& n = wheel.normal;
  WheelStep step;
  const Eigen::Vector3d axle =
      (before.linear() * wheel.axle + after.linear() * wheel.axle).normalized();
  const Eigen::Vector3d in_plane = axle - n * n.dot(axle);
  if (in_plane.norm() < 1e-9) return step;
  step.across = in_plane.normalized();
  step.heading = step.across.cross(n);
  const Eigen::Vector3d moved = after * effector.point - before * effector.point;
  const Eigen::AngleAxisd turned(Eigen::Matrix3d(after.linear() * before.linear().transpose()));
  const Eigen::Vector3d turn = turned.angle() * turned.axis();
  const Eigen::Vector3d up = (n - axle * axle.dot(n)).normalized();
  const Eigen::Vector3d slip = moved - effector.radius_m * turn.cross(up);
  step.lateral_m = slip.dot(step.across);
  step.longitudinal_m = slip.dot(step.heading);
  step.way_m =
      std::min(std::abs(moved.dot(step.heading)), effector.radius_m * std::abs(turn.dot(axle)));
  return step;
}

void StretchRange::add(double way_m, double value) {
  for (std::deque<Entry>* entries : {&falling_, &rising_})
    while (!entries->empty() && entries->front().way_m < way_m - stretch_m_) entries->pop_front();
  while (!falling_.empty() && falling_.back().value <= value) falling_.pop_back();
  while (!rising_.empty() && rising_.back().value >= value) rising_.pop_back();
  falling_.push_back({way_m, value});
  rising_.push_back({way_m, value});
  largest_ = std::max(largest_, falling_.front().value - rising_.front().value);
}

WheelSlip::WheelSlip()
    : lateral_{StretchRange(limits::kSlipStretch_m)},
      longitudinal_{StretchRange(limits::kSlipStretch_m)} {
  lateral_.range.add(0.0, 0.0);
  longitudinal_.range.add(0.0, 0.0);
}

void WheelSlip::Direction::add(double slip, double in_world, double way) {
  total += slip;
  range.add(way, total);
  const double allowed = limits::kSlip_m + limits::kSlipShare * way;
  const double most = std::max(std::abs(total), std::abs(in_world));
  worst = std::max({worst, range.largest(), most * (limits::kSlip_m / allowed)});
}

void WheelSlip::add(const WheelStep& step) {
  way_m_ += step.way_m;
  in_world_ += step.lateral_m * step.across + step.longitudinal_m * step.heading;
  lateral_.add(step.lateral_m, in_world_.dot(step.across), way_m_);
  longitudinal_.add(step.longitudinal_m, in_world_.dot(step.heading), way_m_);
}

}  // namespace locograph
