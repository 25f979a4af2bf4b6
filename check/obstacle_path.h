#pragma once
/// How far moving obstacles can get in an interval of time.
///
///     locograph::ObstaclePath path(obstacles);
///     double at_most_m = path.bound(2.0, 2.5);  // no point of any obstacle travels further
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
  /// When every obstacle has been wherever it gets to, counted from time 0; 0: none moves.
  double end_s() const;

 private:
  struct Track {
    std::vector<double> time_s, length_m;  // corners of the path length since time 0
    bool repeats = false;
    double length_until(double time_s) const;
  };
  std::vector<Track> tracks_;  // of the obstacles that move
};

}  // namespace locograph
