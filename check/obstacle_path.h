#pragma once
/// How far moving obstacles can get in an interval of time.
///
///     locograph::ObstaclePath path(obstacles);
///     double at_most_m = path.bound(2.0, 2.5);  // no point of any obstacle travels further
///     double first_m = path.bound(0, 2.0, 2.5);  // nor any point of the first one
///
/// By world/obstacle_way.h, added up along the key frames.

#include <locograph/world/obstacles.h>

#include <span>
#include <vector>

namespace locograph {

class ObstaclePath {
 public:
  explicit ObstaclePath(std::span<const Obstacle> obstacles);

  /// Path length [m] between two times, in either order: the largest of all obstacles.
  double bound(double from_s, double to_s) const;
  /// Of one obstacle, by its place in the list.
  double bound(std::size_t obstacle, double from_s, double to_s) const;
  /// By then an obstacle that is there from a time on has been wherever it gets to: once round,
  /// where it repeats its way.
  double seen_s(std::size_t obstacle, double from_s) const;
  /// After so long, from any time that is not negative, every obstacle has been wherever it gets to
  /// from then on; 0: none moves or appears.
  double end_s() const { return end_s_; }

 private:
  struct Track {
    std::vector<double> time_s, length_m;  // corners of the path length since time 0
    bool repeats = false;
    double length_until(double time_s) const;
    double length_between(double from_s, double to_s) const;
  };
  std::vector<Track> tracks_;          // of the obstacles that move
  std::vector<std::size_t> track_of_;  // of each obstacle; of one at rest none
  double end_s_ = 0.0;
};

}  // namespace locograph
