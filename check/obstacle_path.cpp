#include <locograph/check/obstacle_path.h>
#include <locograph/world/obstacle_way.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace locograph {
namespace {

constexpr std::size_t kAtRest = std::numeric_limits<std::size_t>::max();

}  // namespace

ObstaclePath::ObstaclePath(std::span<const Obstacle> obstacles) {
  for (const Obstacle& obstacle : obstacles) {
    track_of_.push_back(obstacle.motion.empty() ? kAtRest : tracks_.size());
    const double appears_s = std::max(0.0, obstacle.appears_s);
    end_s_ = std::max(end_s_, appears_s);
    if (obstacle.motion.empty()) continue;
    Track track;
    track.repeats = obstacle.repeat_s > 0.0;
    track.time_s = {0.0};
    track.length_m = {0.0};
    Eigen::Isometry3d pose = obstacle.world_from_obstacle;
    const auto append = [&](double time, const Eigen::Isometry3d& next) {
      track.time_s.push_back(time);
      track.length_m.push_back(track.length_m.back() + way_m(obstacle, pose, next));
      pose = next;
    };
    for (const KeyFrame& frame : obstacle.motion) append(frame.time_s, frame.pose);
    if (track.repeats) append(obstacle.repeat_s, obstacle.world_from_obstacle);
    end_s_ = std::max(end_s_, track.time_s.back() + (track.repeats ? appears_s : 0.0));
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

double ObstaclePath::Track::length_between(double from_s, double to_s) const {
  return std::abs(length_until(to_s) - length_until(from_s));
}

double ObstaclePath::bound(double from_s, double to_s) const {
  double longest = 0.0;
  for (const Track& track : tracks_)
    longest = std::max(longest, track.length_between(from_s, to_s));
  return longest;
}

double ObstaclePath::bound(std::size_t obstacle, double from_s, double to_s) const {
  const std::size_t track = track_of_[obstacle];
  return track == kAtRest ? 0.0 : tracks_[track].length_between(from_s, to_s);
}

double ObstaclePath::seen_s(std::size_t obstacle, double from_s) const {
  if (track_of_[obstacle] == kAtRest) return from_s;
  const Track& track = tracks_[track_of_[obstacle]];
  return track.repeats ? from_s + track.time_s.back() : std::max(from_s, track.time_s.back());
}

}  // namespace locograph
