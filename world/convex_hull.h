#pragma once
/// The convex hull of points in a plane.
///
///     const std::vector<PlanePoint> corners = convex_hull({{0, 0}, {2, 0}, {1, 0.5}, {1, 2}});
///     // (0, 0), (2, 0), (1, 2)

#include <vector>

namespace locograph {

struct PlanePoint {
  double x = 0.0, y = 0.0;
};

/// Its corners as they go round, counter-clockwise, the one of least x and then least y first. Of
/// points on a line their ends; none of fewer than two points.
std::vector<PlanePoint> convex_hull(std::vector<PlanePoint> points);

}  // namespace locograph
