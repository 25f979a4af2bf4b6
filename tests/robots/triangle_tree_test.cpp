#include <gtest/gtest.h>
#include <locograph/common/uniform.h>
#include <locograph/robots/triangle_tree.h>

#include <cmath>
#include <random>

namespace locograph {
namespace {

Eigen::Vector3d drawn(std::mt19937_64& random) {
  const double x = uniform(random, -1.0, 1.0), y = uniform(random, -1.0, 1.0);
  return {x, y, uniform(random, -1.0, 1.0)};
}

/// By the plane of each triangle and on which side of its three edges the ray passes it.
double first_of_all(const std::vector<Eigen::Vector3d>& corners, const Eigen::Vector3d& origin,
                    const Eigen::Vector3d& direction) {
  double first = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < corners.size(); c += 3) {
    const Eigen::Vector3d &a = corners[c], &b = corners[c + 1], &d = corners[c + 2];
    const Eigen::Vector3d normal = (b - a).cross(d - a);
    const double t = normal.dot(a - origin) / normal.dot(direction);
    const Eigen::Vector3d p = origin + t * direction;
    if (t > 0.0 && (b - a).cross(p - a).dot(normal) >= 0.0 &&
        (d - b).cross(p - b).dot(normal) >= 0.0 && (a - d).cross(p - d).dot(normal) >= 0.0)
      first = std::min(first, t);
  }
  return first;
}

TEST(TriangleTree, RaysMeetTheFirstTriangleOfAll) {
  std::mt19937_64 random(6);
  std::vector<Eigen::Vector3d> corners;
  for (int triangle = 0; triangle < 300; ++triangle) {
    const Eigen::Vector3d middle = drawn(random);
    for (int corner = 0; corner < 3; ++corner) corners.push_back(middle + 0.1 * drawn(random));
  }
  const TriangleTree tree(corners);
  int met = 0;
  for (int ray = 0; ray < 10000; ++ray) {
    const Eigen::Vector3d origin = 1.5 * drawn(random), direction = drawn(random);
    const double expected = first_of_all(corners, origin, direction);
    const double first = tree.first_hit(origin, direction);
    if (std::isinf(expected)) {
      EXPECT_EQ(first, expected) << ray;
      continue;
    }
    EXPECT_NEAR(first, expected, 1e-9 * (1.0 + expected)) << ray;
    EXPECT_EQ(tree.first_hit(origin, direction, 0.5 * expected), 0.5 * expected);
    ++met;
  }
  EXPECT_GT(met, 300);
}

TEST(TriangleTree, RaysAlongAnAxisMeetWhatStandsAcross) {
  const TriangleTree tree(
      {{1, -1, -1}, {1, 3, -1}, {1, -1, 3}, {2, -1, -1}, {2, 3, -1}, {2, -1, 3}});
  const Eigen::Vector3d forward = Eigen::Vector3d::UnitX();
  EXPECT_NEAR(tree.first_hit({0, 0, 0}, forward), 1.0, 1e-12);
  EXPECT_NEAR(tree.first_hit({1.5, 0, 0}, forward), 0.5, 1e-12);
  EXPECT_NEAR(tree.first_hit({1.5, 0, 0}, -forward), 0.5, 1e-12);
  EXPECT_TRUE(std::isinf(tree.first_hit({3.0, 0, 0}, forward)));
  EXPECT_TRUE(std::isinf(tree.first_hit({0, -1.5, 0}, forward)));
}

}  // namespace
}  // namespace locograph
