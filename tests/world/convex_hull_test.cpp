#include <gtest/gtest.h>
#include <locograph/world/convex_hull.h>

#include <utility>

namespace locograph::convex_hull_test {
namespace {

std::vector<std::pair<double, double>> hull_of(const std::vector<PlanePoint>& points) {
  std::vector<std::pair<double, double>> corners;
  for (const PlanePoint& point : convex_hull(points)) corners.emplace_back(point.x, point.y);
  return corners;
}

using Corners = std::vector<std::pair<double, double>>;

TEST(ConvexHull, GoesRoundTheCornersCounterClockwise) {
  EXPECT_EQ(hull_of({{2, 2}, {0, 0}, {1, 1}, {2, 0}, {0, 2}}),
            (Corners{{0, 0}, {2, 0}, {2, 2}, {0, 2}}));
}

TEST(ConvexHull, LeavesOutPointsOnSidesAndPointsThatAreGivenTwice) {
  EXPECT_EQ(hull_of({{0, 0}, {1, 0}, {2, 0}, {2, 0}, {0, 1}, {0, 0}}),
            (Corners{{0, 0}, {2, 0}, {0, 1}}));
}

TEST(ConvexHull, OfALineAreItsEndsAndOfOnePointIsNothing) {
  EXPECT_EQ(hull_of({{1, 1}, {0, 0}, {2, 2}}), (Corners{{0, 0}, {2, 2}}));
  EXPECT_EQ(hull_of({{1, 1}}), Corners());
  EXPECT_EQ(hull_of({}), Corners());
}

}  // namespace
}  // namespace locograph::convex_hull_test
