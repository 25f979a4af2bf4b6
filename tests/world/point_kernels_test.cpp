#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/world/distance_view.h>
#include <locograph/world/octree.h>
#include <locograph/world/point_kernels.h>

#include <limits>
#include <random>

namespace locograph {
namespace {

/// Points that lie in three arrays; nothing may be written or read beyond them.
struct Points {
  std::vector<double> x, y, z;

  void add(const Eigen::Vector3d& point) {
    x.push_back(point[0]);
    y.push_back(point[1]);
    z.push_back(point[2]);
  }
  Eigen::Vector3d at(std::size_t i) const { return {x[i], y[i], z[i]}; }
  PointList list(int count) const { return {x.data(), y.data(), z.data(), count}; }
};

Points random_points(std::size_t count, double within_m) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-within_m, within_m);
  Points points;
  while (points.x.size() < count) {
    points.add({uniform(random), uniform(random), uniform(random)});
  }
  return points;
}

Obstacle turned(Obstacle::Shape shape, const Eigen::Vector3d& size) {
  Obstacle obstacle;
  obstacle.shape = shape;
  obstacle.size = size;
  obstacle.world_from_obstacle.linear() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  obstacle.world_from_obstacle.translation() << 0.2, -0.1, 0.3;
  return obstacle;
}

PlacedShape placed(const Obstacle& obstacle, const Eigen::Vector3d& size) {
  PlacedShape shape;
  Eigen::Map<Eigen::Matrix3d>(shape.axes) = obstacle.world_from_obstacle.linear();
  Eigen::Map<Eigen::Vector3d>(shape.origin) = obstacle.world_from_obstacle.translation();
  Eigen::Map<Eigen::Vector3d>(shape.size) = size;
  return shape;
}

/// Boxes in a voxel map, as a field.
DistanceField some_field() {
  std::vector<Box> boxes(2);
  boxes[0].size << 0.4, 0.2, 0.6;
  boxes[1].size << 0.3, 0.3, 0.3;
  boxes[1].world_from_box.translation() << 0.5, 0.6, -0.4;
  DistanceFieldOptions options;
  options.max_distance_m = 0.4;
  return DistanceField::from_octree(*octree_from_boxes(boxes, 0.05), options);
}

FieldNodes nodes_of(const DistanceField& field) {
  FieldNodes nodes{field.values().data(), {}, {}, {}, 1.0 / field.resolution(),
                   field.max_distance()};
  for (int axis = 0; axis < 3; ++axis) {
    nodes.dimensions[axis] = field.dimensions()[axis];
    nodes.lower[axis] = field.lower()[axis];
    nodes.upper[axis] = field.upper()[axis];
  }
  return nodes;
}

class PointKernelsTest : public testing::TestWithParam<std::string> {
 protected:
  const PointKernels& kernels_ = point_kernels_at(GetParam());

  /// lower(points, nearest) against distance_of(point), for all counts up to two registers, and
  /// where nearest is lower already.
  template <class Lower, class Distance>
  static void expect_equal(const Points& points, Lower&& lower, Distance&& distance_of) {
    int inside = 0;
    for (int count = 0; count <= static_cast<int>(points.x.size()); count += count < 17 ? 1 : 100) {
      std::vector<double> nearest(points.x.size(), std::numeric_limits<double>::infinity());
      for (std::size_t i = 0; i < nearest.size(); i += 3) nearest[i] = 0.05;
      const std::vector<double> before = nearest;
      lower(points.list(count), nearest.data());
      for (std::size_t i = 0; i < nearest.size(); ++i) {
        if (i >= static_cast<std::size_t>(count)) {
          EXPECT_EQ(nearest[i], before[i]);
          continue;
        }
        const double distance = distance_of(points.at(i));
        EXPECT_NEAR(nearest[i], std::min(before[i], distance), 1e-13) << points.at(i).transpose();
        inside += distance < 0.0;
      }
    }
    EXPECT_GT(inside, 100);
  }
};
INSTANTIATE_TEST_SUITE_P(Levels, PointKernelsTest, testing::ValuesIn(simd_levels()));

TEST_P(PointKernelsTest, ShapesAgreeWithASampleOfEach) {
  Points points = random_points(1000, 0.6);
  points.add({0.2, -0.1, 0.3});  // the middle of all of them
  const Obstacle box = turned(Obstacle::Shape::kBox, {0.4, 0.6, 0.3}),
                 sphere = turned(Obstacle::Shape::kSphere, {0.3, 0.0, 0.0}),
                 cylinder = turned(Obstacle::Shape::kCylinder, {0.25, 0.5, 0.0});
  expect_equal(
      points,
      [&](const PointList& list, double* nearest) {
        kernels_.box(placed(box, 0.5 * box.size), list, nearest);
      },
      [&](const Eigen::Vector3d& p) { return box.distance(p, 0.0); });
  expect_equal(
      points,
      [&](const PointList& list, double* nearest) {
        kernels_.sphere(placed(sphere, sphere.size), list, nearest);
      },
      [&](const Eigen::Vector3d& p) { return sphere.distance(p, 0.0); });
  expect_equal(
      points,
      [&](const PointList& list, double* nearest) {
        kernels_.cylinder(placed(cylinder, {0.25, 0.25, 0.0}), list, nearest);
      },
      [&](const Eigen::Vector3d& p) { return cylinder.distance(p, 0.0); });
}

TEST_P(PointKernelsTest, AFieldAgreesWithItsSamplesInsideAndBeyond) {
  const DistanceField field = some_field();
  const FieldNodes nodes = nodes_of(field);
  Points points = random_points(3000, 0.9);
  points.add(field.lower());
  points.add(field.upper());
  points.add({100.0, -100.0, 0.0});
  points.add(field.upper() + Eigen::Vector3d(0.0, 0.01, 0.0));
  expect_equal(
      points, [&](const PointList& list, double* nearest) { kernels_.field(nodes, list, nearest); },
      [&](const Eigen::Vector3d& p) { return field.distance(p); });
}

TEST_P(PointKernelsTest, WhatIsNoNumberReadsNothingBeyondTheField) {
  const DistanceField field = some_field();
  constexpr double kNot = std::numeric_limits<double>::quiet_NaN(), kHuge = 1e300;
  Points points;
  for (const double x : {kNot, kHuge, -kHuge, 0.1}) {
    for (const double y : {kNot, kHuge, 0.1}) points.add({x, y, 0.1});
  }
  std::vector<double> nearest(points.x.size(), 1.0);
  kernels_.field(nodes_of(field), points.list(static_cast<int>(nearest.size())), nearest.data());
  EXPECT_LT(nearest.back(), 1.0);  // the one point that is there
  // Beside one that is none, beyond the field as ever.
  Points beyond;
  beyond.add({kNot, 0.1, 0.1});
  beyond.add(field.upper() + Eigen::Vector3d::Constant(0.1));
  std::vector<double> two(2, 1.0);
  kernels_.field(nodes_of(field), beyond.list(2), two.data());
  EXPECT_EQ(two[0], 1.0);
  EXPECT_NEAR(two[1], field.distance(beyond.at(1)), 1e-13);
}

TEST(PointKernels, AWorldTellsDistancesOfPointsAsOfEach) {
  World world;
  std::vector<Box> boxes(1);
  boxes[0].size << 0.4, 0.2, 0.6;
  world.map = octree_from_boxes(boxes, 0.05);
  world.obstacles = {turned(Obstacle::Shape::kBox, {0.1, 0.6, 0.3}),
                     turned(Obstacle::Shape::kSphere, {0.1, 0.0, 0.0}),
                     turned(Obstacle::Shape::kCylinder, {0.1, 0.5, 0.0})};
  KeyFrame later{2.0, world.obstacles[0].world_from_obstacle};
  later.pose.translation().x() += 0.5;
  world.obstacles[0].motion.push_back(later);
  world.obstacles[1].world_from_obstacle.translation().y() = 0.4;
  world.obstacles[1].appears_s = 1.5;
  world.obstacles[2].world_from_obstacle.translation().y() = -0.5;
  World without_map = world;
  without_map.map = nullptr;
  const Points points = random_points(200, 0.8);
  for (const WorldDistance& seen : {distance_view(world), distance_view(without_map)}) {
    for (const double time_s : {0.0, 1.0, 3.0}) {
      std::vector<double> distances(points.x.size(), -7.0);
      seen.distances(points.list(200), time_s, distances.data());
      for (std::size_t i = 0; i < distances.size(); ++i) {
        EXPECT_NEAR(distances[i], seen.distance(points.at(i), time_s), 1e-13);
      }
    }
  }
}

TEST(PointKernels, ALevelThatThereIsNotIsAnError) { EXPECT_THROW(point_kernels_at("v1"), Error); }

}  // namespace
}  // namespace locograph
