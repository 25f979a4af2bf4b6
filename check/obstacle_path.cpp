#include <locograph/check/obstacle_path.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

double turning_radius(const Obstacle& obstacle) {
  switch (obstacle.shape) {
    case Obstacle::Shape::kSphere:
      return 0.0;
    case Obstacle::Shape::kCylinder:
      return std::hypot(obstacle.size[0], 0.5 * obstacle.size[1]);
    case Obstacle::Shape::kBox:
      break;
  }
  return 0.5 * obstacle.size.norm();
}

double piece_length(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double radius) {
  const Eigen::Quaterniond start(from.linear()), end(to.linear());
  return (to.translation() - from.translation()).norm() + start.angularDistance(end) * radius;
}

}  // namespace

ObstaclePath::ObstaclePath(std::span<const Obstacle> obstacles) {
  for (const Obstacle& obstacle : obstacles) {
    if (obstacle.motion.empty()) continue;
    const double radius = turning_radius(obstacle);
    Track track;
    track.repeats = obstacle.repeat_s > 0.0;
    track.time_s = {0.0};
    track.length_m = {0.0};
    Eigen::Isometry3d pose = obstacle.world_from_obstacle;
    const auto append = [&](double time, const Eigen::Isometry3d& next) {
      track.time_s.push_back(time);
      track.length_m.push_back(track.length_m.back() + piece_length(pose, next, radius));
      pose = next;
    };
    for (const KeyFrame& frame : obstacle.motion) append(frame.time_s, frame.pose);
    if (track.repeats) append(obstacle.repeat_s, obstacle.world_from_obstacle);
    tracks_.push_back(std::move(track));
  }
}

double ObstaclePath::Track::length_until(double time) const {
  if (time <= 0.0) return 0.0;
  double length = 0.0;
  if (repeats) {
    const double periods = std::floor(time / time_s.back());
    length = periods * length_m.back();
    time -= periods * time_s.back();
  }
  if (time >= time_s.back()) return length + length_m.back();
  const std::size_t after =
      std::size_t(std::upper_bound(time_s.begin(), time_s.end(), time) - time_s.begin());
  if (after == 0) return length;
  const double share = (time - time_s[after - 1]) / (time_s[after] - time_s[after - 1]);
  return length + length_m[after - 1] + share * (length_m[after] - length_m[after - 1]);
}

double ObstaclePath::bound(double from_s, double to_s) const {
  double longest = 0.0;
  for (const Track& track : tracks_)
    longest = std::max(longest, std::abs(track.length_until(to_s) - track.length_until(from_s)));
  return longest;
}

}  // namespace locograph
