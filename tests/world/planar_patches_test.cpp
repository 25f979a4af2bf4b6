#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/world/planar_patches.h>
#include <locograph/world/point_cloud.h>
#include <locograph/world/rectangles.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "world/synthetic_cloud.h"

namespace locograph {
namespace {

using test::SyntheticCloud;

Eigen::Vector3d normal(const Surface& surface) {
  return surface.world_from_surface.linear().col(2);
}

/// The largest surface whose normal is within 2 degrees of a direction, close to a point's plane.
const Surface* facing(const std::vector<Surface>& surfaces, const Eigen::Vector3d& direction,
                      const Eigen::Vector3d& point) {
  for (const Surface& surface : surfaces) {
    const Eigen::Vector3d centre = surface.world_from_surface.translation();
    if (normal(surface).dot(direction) > std::cos(0.035) &&
        std::abs(direction.dot(centre - point)) < 0.01) {
      return &surface;
    }
  }
  return nullptr;
}

/// A floor of 3 m x 3 m, a wall at x = 1.5 and a turned box of 0.5 x 0.4 x 0.3 m on the floor.
SyntheticCloud room(double noise_m) {
  SyntheticCloud cloud(noise_m);
  Eigen::Isometry3d box = Eigen::Isometry3d::Identity();
  box.translate(Eigen::Vector3d(0.3, -0.2, 0.15));
  box.rotate(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
  const auto under_box = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d at = box.inverse() * p;
    return std::abs(at.x()) < 0.25 && std::abs(at.y()) < 0.2;
  };
  cloud.rectangle({-1.5, -1.5, 0}, {3, 0, 0}, {0, 3, 0}, under_box);
  cloud.rectangle({1.5, -1.5, 0}, {0, 3, 0}, {0, 0, 2});
  cloud.box(box, {0.5, 0.4, 0.3});
  return cloud;
}

TEST(PlanarPatches, FindsFloorWallAndBoxThroughNoise) {
  const SyntheticCloud cloud = room(0.005);
  const std::vector<Surface> surfaces = planar_patches(cloud.points);
  const Surface* floor = facing(surfaces, Eigen::Vector3d::UnitZ(), {0, 0, 0});
  ASSERT_NE(floor, nullptr);
  EXPECT_GT(4 * floor->half_x_m * floor->half_y_m, 3.0);
  const Surface* wall = facing(surfaces, -Eigen::Vector3d::UnitX(), {1.5, 0, 0});
  ASSERT_NE(wall, nullptr) << "its normal points to where the floor is";
  EXPECT_NEAR(4 * wall->half_x_m * wall->half_y_m, 6.0, 0.5);
  const Surface* top = facing(surfaces, Eigen::Vector3d::UnitZ(), {0, 0, 0.3});
  ASSERT_NE(top, nullptr);
  EXPECT_NEAR(std::max(top->half_x_m, top->half_y_m), 0.25, 0.03);
  EXPECT_NEAR(std::min(top->half_x_m, top->half_y_m), 0.20, 0.03);
  EXPECT_NEAR(top->world_from_surface.translation().z(), 0.3, 0.004);
  for (int side = 0; side < 4; ++side) {
    const double turn = 0.4 + 0.5 * std::numbers::pi * side;
    const Eigen::Vector3d out(std::cos(turn), std::sin(turn), 0.0);
    const double half = side % 2 == 0 ? 0.25 : 0.2;
    EXPECT_NE(facing(surfaces, out, Eigen::Vector3d(0.3, -0.2, 0.0) + half * out), nullptr)
        << "side " << side << " of the box, outwards";
  }
  EXPECT_TRUE(
      std::is_sorted(surfaces.begin(), surfaces.end(), [](const Surface& a, const Surface& b) {
        return a.half_x_m * a.half_y_m > b.half_x_m * b.half_y_m;
      }));
}

TEST(PlanarPatches, NeverReachOverWhatWasSeen) {
  const SyntheticCloud cloud = room(0.0);
  for (const Surface& surface : planar_patches(cloud.points)) {
    for (double x = -1.0; x <= 1.0; x += 0.125)
      for (double y = -1.0; y <= 1.0; y += 0.125) {
        const Eigen::Vector3d point =
            surface.world_from_surface *
            Eigen::Vector3d(x * surface.half_x_m, y * surface.half_y_m, 0.0);
        double nearest = 1.0;
        for (const Eigen::Vector3d& p : cloud.points) {
          nearest = std::min(nearest, (p - point).norm());
        }
        EXPECT_LT(nearest, 0.03) << point.transpose();
      }
  }
}

TEST(PlanarPatches, LeaveHolesOut) {
  SyntheticCloud cloud(0.002);
  const auto hole = [](const Eigen::Vector3d& p) { return std::hypot(p.x(), p.y()) < 0.2; };
  cloud.rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, hole);
  const std::vector<Surface> surfaces = planar_patches(cloud.points);
  EXPECT_GE(surfaces.size(), 4u);
  for (const Surface& surface : surfaces) {
    const Eigen::Vector3d middle = surface.world_from_surface.inverse() * Eigen::Vector3d::Zero();
    EXPECT_FALSE(std::abs(middle.x()) < surface.half_x_m &&
                 std::abs(middle.y()) < surface.half_y_m);
  }
}

TEST(PlanarPatches, NormalsPointToTheViewpoint) {
  SyntheticCloud cloud(0.002);
  cloud.rectangle({-1, -1, 2}, {2, 0, 0}, {0, 2, 0});
  PatchOptions options;
  ASSERT_FALSE(planar_patches(cloud.points, options).empty());
  EXPECT_GT(normal(planar_patches(cloud.points, options)[0]).z(), 0.99);
  options.viewpoint = Eigen::Vector3d(0, 0, 1);
  EXPECT_LT(normal(planar_patches(cloud.points, options)[0]).z(), -0.99) << "a ceiling";
}

TEST(PlanarPatches, FindStepsThatAreLowAndSlopesAsOnePlane) {
  SyntheticCloud cloud(0.003);
  for (int step = 0; step < 4; ++step) {
    cloud.rectangle({0.3 * step, -0.5, 0.17 * step}, {0.3, 0, 0}, {0, 1, 0});
    cloud.rectangle({0.3 * step, -0.5, 0.17 * (step - 1)}, {0, 1, 0}, {0, 0, 0.17});
  }
  cloud.rectangle({-2.0, -0.5, -0.5}, {1, 0, 0.5}, {0, 1, 0});
  const std::vector<Surface> surfaces = planar_patches(cloud.points);
  for (int step = 0; step < 4; ++step) {
    const Surface* found = facing(surfaces, Eigen::Vector3d::UnitZ(), {0, 0, 0.17 * step});
    ASSERT_NE(found, nullptr) << step;
    EXPECT_NEAR(std::min(found->half_x_m, found->half_y_m), 0.15, 0.03);
    EXPECT_NEAR(std::max(found->half_x_m, found->half_y_m), 0.5, 0.03);
    EXPECT_NE(facing(surfaces, -Eigen::Vector3d::UnitX(), {0.3 * step, 0, 0}), nullptr) << "riser";
  }
  EXPECT_EQ(surfaces.size(), 9u) << "each of them once";
  const Eigen::Vector3d up = Eigen::Vector3d(-0.5, 0, 1).normalized();
  const Surface* slope = facing(surfaces, up, {-2.0, 0, -0.5});
  ASSERT_NE(slope, nullptr);
  EXPECT_NEAR(4 * slope->half_x_m * slope->half_y_m, std::sqrt(1.25), 0.1);
}

TEST(PlanarPatches, AreTheSameEveryTime) {
  const SyntheticCloud cloud = room(0.005);
  const std::vector<Surface> a = planar_patches(cloud.points), b = planar_patches(cloud.points);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].world_from_surface.matrix(), b[i].world_from_surface.matrix());
    EXPECT_EQ(a[i].half_x_m, b[i].half_x_m);
  }
}

TEST(PlanarPatches, FewPointsHaveNoneAndBadOnesAreErrors) {
  EXPECT_TRUE(planar_patches({}).empty());
  std::vector<Eigen::Vector3d> points(5, Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(planar_patches(points).empty());
  EXPECT_TRUE(bars_in(points).empty());
  points[2].x() = 1e7;
  EXPECT_THROW(planar_patches(points), Error);
  points[2].x() = std::nan("");
  EXPECT_THROW(planar_patches(points), Error);
  points[2].x() = 9e5;
  EXPECT_THROW(planar_patches(points), Error) << "two million voxels";
  PatchOptions options;
  options.voxel_m = 0.0;
  EXPECT_THROW(planar_patches({}, options), Error);
}

TEST(PlanarPatches, OfThePublicTablesAreTheTables) {
  const std::filesystem::path clouds =
      std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "point_clouds";
  if (!std::filesystem::exists(clouds)) GTEST_SKIP() << clouds << " is missing";
  for (const char* name : {"table_scene_0.pcd", "table_scene_1.pcd"}) {
    PatchOptions options;
    options.viewpoint = Eigen::Vector3d::Zero();
    const auto points = load_point_cloud(clouds / name);
    const std::vector<PlanarRegion> regions = planar_regions(points, options);
    ASSERT_FALSE(regions.empty());
    std::size_t most = 0;
    for (const PlanarRegion& region : regions) most = std::max(most, region.points.size());
    EXPECT_GT(most, points.size() / 2) << name;
    for (const PlanarRegion& region : regions)
      for (const Surface& surface : region.surfaces) {
        const Eigen::Vector3d centre = surface.world_from_surface.translation();
        EXPECT_GT(normal(surface).dot(-centre), 0.0) << "towards the camera";
      }
  }
}

TEST(Bars, OfALadderAreItsRungsAndRails) {
  for (const double noise_m : {0.0, 0.003}) {
    SyntheticCloud cloud(noise_m);
    for (const double y : {-0.3, 0.3}) cloud.bar({1, y, 0}, {1, y, 2.0}, 0.025);
    for (int rung = 1; rung <= 6; ++rung) {
      cloud.bar({1, -0.3, 0.3 * rung}, {1, 0.3, 0.3 * rung}, 0.018);
    }
    const std::vector<Bar> bars = bars_in(cloud.points);
    ASSERT_EQ(bars.size(), 8u) << noise_m;
    int level = 0, upright = 0;
    for (const Bar& bar : bars) {
      const Eigen::Vector3d along = bar.to - bar.from, middle = 0.5 * (bar.from + bar.to);
      EXPECT_NEAR(middle.x(), 1.0, 0.005);
      if (std::abs(along.y()) > 0.9 * along.norm()) {
        ++level;
        EXPECT_NEAR(bar.radius_m, 0.018, 0.005);
        EXPECT_NEAR(std::remainder(middle.z(), 0.3), 0.0, 0.005);
        EXPECT_NEAR(along.norm(), 0.6, 0.08);
      } else {
        ++upright;
        EXPECT_NEAR(bar.radius_m, 0.025, 0.005);
        EXPECT_NEAR(std::abs(middle.y()), 0.3, 0.005);
        EXPECT_NEAR(along.norm(), 2.0, 0.05);
      }
    }
    EXPECT_EQ(level, 6);
    EXPECT_EQ(upright, 2);
  }
}

TEST(Bars, SeenFromOneSideAreFoundToACentimetre) {
  SyntheticCloud cloud(0.001);
  const auto behind = [](const Eigen::Vector3d& p) { return p.x() > 0.005; };
  cloud.bar({0, -0.5, 1}, {0, 0.5, 1.2}, 0.02, behind);
  const std::vector<Bar> bars = bars_in(cloud.points);
  ASSERT_EQ(bars.size(), 1u);
  EXPECT_NEAR(bars[0].radius_m, 0.02, 0.01);
  EXPECT_LT((0.5 * (bars[0].from + bars[0].to) - Eigen::Vector3d(0, 0, 1.1)).norm(), 0.01);
}

TEST(Bars, AreNotFoundInFloorsAndBoxes) { EXPECT_TRUE(bars_in(room(0.003).points).empty()); }

TEST(Rectangles, CoverAnLWithTwoThatOverlap) {
  std::vector<Cell> cells;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 3; ++j) cells.insert(cells.end(), {{i, j}, {j, i}});
  const auto found = cell_rectangles(cells, {.least_length = 3, .least_width = 2});
  ASSERT_EQ(found.size(), 2u);
  for (const CellRectangle& r : found) {
    EXPECT_EQ((r.to.x - r.from.x + 1) * (r.to.y - r.from.y + 1), 30);
  }
  EXPECT_TRUE(cell_rectangles(cells, {.least_length = 3, .least_width = 4}).empty());
  EXPECT_TRUE(cell_rectangles({}, {}).empty());
}

TEST(Rectangles, SmallestFrameOfATurnedRectangleIsTurned) {
  std::vector<PlanePoint> points;
  for (double x = 0; x <= 2.0; x += 0.25)
    for (double y = 0; y <= 1.0; y += 0.25)
      points.push_back(
          {std::cos(0.3) * x - std::sin(0.3) * y, std::sin(0.3) * x + std::cos(0.3) * y});
  const PlaneFrame frame = smallest_frame(points);
  EXPECT_NEAR(frame.angle_rad, 0.3, 1e-9);
  EXPECT_NEAR(frame.upper_x - frame.lower_x, 2.0, 1e-9);
  EXPECT_NEAR(frame.upper_y - frame.lower_y, 1.0, 1e-9);
}

}  // namespace
}  // namespace locograph
