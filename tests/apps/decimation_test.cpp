// Fewer triangles that still look like the mesh.
#include <gtest/gtest.h>
#include <locograph/apps/decimation.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace locograph {
namespace {

/// Rings of squares of two triangles each.
std::vector<Eigen::Vector3d> ball(int rings) {
  const auto at = [&](int i, int k) {
    const double up = std::numbers::pi * i / rings, around = std::numbers::pi * k / rings;
    return Eigen::Vector3d(std::sin(up) * std::cos(around), std::sin(up) * std::sin(around),
                           std::cos(up));
  };
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < 2 * rings; ++k) {
      for (const Eigen::Vector3d& corner :
           {at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k), at(i + 1, k + 1), at(i, k + 1)}) {
        corners.push_back(corner);
      }
    }
  }
  return corners;
}

TEST(Decimation, LeavesSmallMeshesAsTheyAre) {
  const std::vector<Eigen::Vector3d> corners = ball(10);
  EXPECT_EQ(decimated(corners, 400), corners);
  EXPECT_TRUE(decimated({}, 10).empty());
}

TEST(Decimation, KeepsTheShapeOfLargeOnes) {
  const std::vector<Eigen::Vector3d> corners = ball(200);  // 160 000 triangles
  const std::vector<Eigen::Vector3d> few = decimated(corners, 2000);
  ASSERT_EQ(few.size() % 3, 0U);
  EXPECT_LE(few.size(), 3U * 2000U);
  EXPECT_GT(few.size(), 3U * 1000U);
  double area = 0.0, outwards = 0.0;
  for (std::size_t t = 0; t < few.size(); t += 3) {
    const Eigen::Vector3d normal = (few[t + 1] - few[t]).cross(few[t + 2] - few[t]);
    const Eigen::Vector3d middle = (few[t] + few[t + 1] + few[t + 2]) / 3.0;
    area += 0.5 * normal.norm();
    outwards += normal.dot(middle) > 0.0 ? 1.0 : 0.0;
    EXPECT_NEAR(middle.norm(), 1.0, 0.05);
  }
  EXPECT_NEAR(area, 4.0 * std::numbers::pi, 0.5);
  EXPECT_GT(outwards, 0.97 * static_cast<double>(few.size()) / 3.0);
}

TEST(Decimation, TakesMeshesWithoutSize) {
  const std::vector<Eigen::Vector3d> point(30, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_TRUE(decimated(point, 1).empty());
}

}  // namespace
}  // namespace locograph
