#include <locograph/world/convex_hull.h>

#include <algorithm>
#include <tuple>

namespace locograph {

std::vector<PlanePoint> convex_hull(std::vector<PlanePoint> points) {
  const auto cross = [](const PlanePoint& o, const PlanePoint& a, const PlanePoint& b) {
    return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
  };
  std::sort(points.begin(), points.end(), [](const PlanePoint& a, const PlanePoint& b) {
    return std::tie(a.x, a.y) < std::tie(b.x, b.y);
  });
  // Andrew's monotone chain: the lower side of the hull, then the upper one back.
  std::vector<PlanePoint> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const PlanePoint& point : points) {
      while (hull.size() >= start + 2 && cross(hull[hull.size() - 2], hull.back(), point) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    if (!hull.empty()) hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

}  // namespace locograph
