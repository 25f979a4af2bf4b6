#include <gtest/gtest.h>
#include <locograph/check/extent.h>

#include <random>

namespace locograph {
namespace {

TEST(Extent, IsNeverSmallerThanTheLargestDistanceAndLittleLarger) {
  std::mt19937 engine(5);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 200; ++trial) {
    Extent extent;
    EXPECT_EQ(extent.size(), 0.0);
    std::vector<Eigen::Vector3d> points;
    const Eigen::Vector3d stretch(normal(engine), normal(engine), normal(engine));
    double farthest = 0.0;
    for (int i = 0; i < 2 + trial % 9; ++i) {
      points.emplace_back(Eigen::Vector3d(normal(engine), normal(engine), normal(engine)));
      points.back() = points.back().cwiseProduct(stretch);
      extent.add(points.back());
      for (const Eigen::Vector3d& other : points)
        farthest = std::max(farthest, (points.back() - other).norm());
      EXPECT_GE(extent.size(), farthest * (1.0 - 1e-12));
      EXPECT_LE(extent.size(), farthest * 1.033);
    }
  }
}

TEST(Extent, LooksAlongDirectionsThatLeaveNoGap) {
  std::mt19937 engine(6);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20000; ++trial) {
    const Eigen::Vector3d any =
        Eigen::Vector3d(normal(engine), normal(engine), normal(engine)).normalized();
    double nearest = 0.0;
    for (const Eigen::Vector3d& direction : Extent::half_sphere())
      nearest = std::max(nearest, std::abs(direction.dot(any)));
    ASSERT_LE(std::acos(std::min(1.0, nearest)), Extent::kCovering_rad);
  }
}

}  // namespace
}  // namespace locograph
