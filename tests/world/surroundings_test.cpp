// What is around a robot: obstacles, surfaces, and what its links may touch.
#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/robots/robot.h>
#include <locograph/world/collision_world.h>
#include <locograph/world/distance_view.h>
#include <locograph/world/octree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "common/temporary_folder.h"

namespace locograph {
namespace {

/// A ball of 0.1 m radius, its centre 0.1 m + `height` above z = 0.
class BallAround : public ::testing::Test {
 protected:
  CollisionWorld::Surroundings at(const World& world, double x, double height, bool touches,
                                  std::vector<int> surfaces = {0},
                                  std::vector<int> bars = {}) const {
    std::vector<Eigen::Isometry3d> poses(1, Eigen::Isometry3d::Identity());
    poses[0].translation() << x, 0.0, 0.1 + height;
    const CollisionWorld::Touch touch{.position = {x, 0.0, 0.0},
                                      .surfaces = std::move(surfaces),
                                      .bars = std::move(bars),
                                      .links = {0}};
    CollisionWorld::Query query{.world_from_link = poses};
    if (touches) query.touches = {&touch, 1};
    return CollisionWorld(robot_, world).surroundings(query);
  }
  static World on_plate(double half) {
    World world;
    world.surfaces = {ground()};
    world.surfaces[0].half_x_m = world.surfaces[0].half_y_m = half;
    return world;
  }

  test::TemporaryFolder folder_;
  Robot robot_ = Robot::load(folder_.write(
      "ball.urdf",
      R"(<robot name="ball"><link name="ball"><collision><geometry><sphere radius="0.1"/>
</geometry></collision></link></robot>)"));
};

TEST_F(BallAround, ReachesIntoTheGroundOrTouchesIt) {
  World world;
  world.surfaces = {ground()};
  EXPECT_NEAR(at(world, 0.0, 0.05, false).surface.distance_m, 0.05, 1e-12);
  EXPECT_NEAR(at(world, 0.0, -0.01, false).surface.distance_m, -0.01, 1e-12);
  EXPECT_NEAR(at(world, 0.0, -5.0, false).surface.distance_m, -5.0, 1e-12);
  const CollisionWorld::Surroundings touching = at(world, 0.0, -0.01, true);
  EXPECT_GT(touching.surface.distance_m, 0.0);
  EXPECT_NEAR(touching.touched.distance_m, -0.01, 1e-12);
  EXPECT_EQ(touching.touched.what, "ground");
  // Only what it touches: not another surface, though that is in the way.
  world.surfaces.push_back(ground());
  world.surfaces[1].world_from_surface.translation().z() = 0.005;
  EXPECT_NEAR(at(world, 0.0, -0.01, true).surface.distance_m, -0.015, 1e-12);
}

TEST_F(BallAround, PassesBesideAndBelowAPlateThatEnds) {
  EXPECT_LT(at(on_plate(0.5), 0.0, -0.01, false).surface.distance_m, 0.0);
  EXPECT_GT(at(on_plate(0.5), 0.0, -0.25, false).surface.distance_m, 0.0);
  EXPECT_NEAR(at(on_plate(0.5), 0.65, -0.1, false).surface.distance_m, 0.05, 1e-3);
  // What touches it is above it, not below.
  EXPECT_NEAR(at(on_plate(0.5), 0.0, -0.25, true).touched.distance_m, -0.25, 1e-9);
}

TEST_F(BallAround, TouchesObstaclesAndVoxelsBehindThePlaneOfItsContactOnly) {
  World world;
  Obstacle table;
  table.name = "table";
  table.size = {1.0, 1.0, 0.5};
  table.world_from_obstacle.translation().z() = -0.25;
  world.obstacles = {table};
  EXPECT_NEAR(at(world, 0.0, -0.01, false, {}).obstacle.distance_m, -0.01, 1e-9);
  EXPECT_GT(at(world, 0.0, -0.01, true, {}).obstacle.distance_m, 0.1);
  EXPECT_NEAR(at(world, 0.0, -0.01, true, {}).touched.distance_m, -0.01, 1e-9);
  world.obstacles[0].world_from_obstacle.translation().z() = -0.2;  // comes out of the plane
  EXPECT_NEAR(at(world, 0.0, -0.01, true, {}).obstacle.distance_m, -0.06, 1e-9);

  std::vector<Box> boxes(1);
  boxes[0].world_from_box.translation().z() = -0.1;
  boxes[0].size << 1.0, 1.0, 0.2;
  world = {octree_from_boxes(boxes, 0.05), {}, {}, {}};
  EXPECT_LT(at(world, 0.0, -0.01, false, {}).obstacle.distance_m, 0.0);
  EXPECT_GT(at(world, 0.0, -0.01, true, {}).obstacle.distance_m, 0.0);
  EXPECT_LT(at(world, 0.0, -0.01, true, {}).touched.distance_m, -0.005);
  // With the ground at the same height they are the ground.
  world.surfaces = {ground()};
  EXPECT_GT(at(world, 0.0, -0.01, false).obstacle.distance_m, 0.0);
  boxes.push_back(boxes[0]);
  boxes[1].world_from_box.translation() << 0.15, 0.0, 0.25;  // a wall beside the foot
  boxes[1].size << 0.1, 1.0, 0.5;
  world.map = octree_from_boxes(boxes, 0.05);
  EXPECT_NEAR(at(world, 0.05, 0.0, true).obstacle.distance_m, -0.05, 1e-9);
}

TEST_F(BallAround, RefusesSurfacesThatAreNone) {
  EXPECT_THROW(CollisionWorld(robot_, on_plate(0.0)), Error);
  EXPECT_THROW(CollisionWorld(robot_, on_plate(-1.0)), Error);
}

/// Along y, its top at z = 0.
Bar rung() {
  return {.name = "rung", .from = {0.0, -0.5, -0.02}, .to = {0.0, 0.5, -0.02}, .radius_m = 0.02};
}

TEST_F(BallAround, HasTheDistanceOfACylinderFromABar) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto some = [&] {
    return Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
  };
  int near = 0;
  for (int i = 0; i < 400; ++i) {
    World world;
    world.bars = {{.name = "", .from = some(), .to = some(), .radius_m = 0.03}};
    const Bar& bar = world.bars[0];
    const Eigen::Vector3d axis = (bar.to - bar.from).normalized();
    const std::vector<Eigen::Isometry3d> poses = {Eigen::Isometry3d(Eigen::Translation3d(
        bar.from + 0.6 * (1.0 + uniform(random)) * (bar.to - bar.from) + 0.2 * some()))};
    const double length = (bar.to - bar.from).norm(),
                 along = axis.dot(poses[0].translation() - bar.from),
                 aside = (poses[0].translation() - bar.from - along * axis).norm() - 0.03,
                 beyond = std::max(-along, along - length);
    const double expected = std::hypot(std::max(0.0, aside), std::max(0.0, beyond)) - 0.1;
    if (aside < 0.0 && beyond < 0.0) continue;  // the ball's centre is in the bar
    const CollisionWorld::Closest closest =
        CollisionWorld(robot_, world).surroundings({.world_from_link = poses}).surface;
    const bool found = expected < 0.15;
    EXPECT_NEAR(closest.distance_m, found ? expected : 0.15, expected < 0.0 ? 1e-4 : 1e-5);
    if (std::abs(expected - 0.15) < 1e-4) continue;
    EXPECT_EQ(closest.link, found ? 0 : -1);
    EXPECT_EQ(closest.what, found ? "bar" : "");
    near += found ? 1 : 0;
  }
  EXPECT_GT(near, 50);
}

TEST_F(BallAround, TouchesTheBarThatItIsSaidToTouchAndNoOther) {
  World world;
  world.bars = {rung(), rung()};
  world.bars[1].name = "rung_2";
  world.bars[1].from.x() = world.bars[1].to.x() = 0.1;
  EXPECT_NEAR(at(world, 0.0, 0.05, false, {}).surface.distance_m, 0.05, 1e-5);
  EXPECT_EQ(at(world, 0.0, -0.01, false, {}).surface.what, "rung");
  const CollisionWorld::Surroundings touching = at(world, 0.0, -0.01, true, {}, {0});
  EXPECT_NEAR(touching.touched.distance_m, -0.01, 1e-9);
  EXPECT_EQ(touching.touched.what, "rung");
  EXPECT_NEAR(touching.surface.distance_m, std::hypot(0.1, 0.11) - 0.12, 1e-5);
  EXPECT_EQ(touching.surface.what, "rung_2");
  // Being below the plane of the contact is no excuse.
  const CollisionWorld::Surroundings other = at(world, 0.0, -0.01, true, {}, {1});
  EXPECT_NEAR(other.surface.distance_m, -0.01, 1e-4);
  EXPECT_EQ(other.touched.link, -1);
}

TEST_F(BallAround, RefusesBarsThatAreNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  World world;
  world.bars = {rung()};
  EXPECT_NO_THROW(CollisionWorld(robot_, world));
  for (const double radius : {0.0, -0.02, nan, std::numeric_limits<double>::infinity()}) {
    world.bars[0].radius_m = radius;
    EXPECT_THROW(CollisionWorld(robot_, world), Error) << radius;
  }
  world.bars = {rung()};
  world.bars[0].to = world.bars[0].from;
  EXPECT_THROW(CollisionWorld(robot_, world), Error);
  world.bars[0].to.x() = nan;
  EXPECT_THROW(CollisionWorld(robot_, world), Error);
}

/// A cube of 1 m whose top is z = 0, with that face alone as a surface.
World on_cube() {
  World world;
  world.surfaces = {ground()};
  world.surfaces[0].half_x_m = world.surfaces[0].half_y_m = 0.5;
  world.solids = {{.name = "cube"}};
  world.solids[0].world_from_box.translation().z() = -0.5;
  return world;
}

TEST_F(BallAround, IsFoundInsideASolid) {
  EXPECT_NEAR(at(on_cube(), 0.0, 0.05, false).surface.distance_m, 0.05, 1e-9);
  EXPECT_NEAR(at(on_cube(), 0.0, -0.01, false).surface.distance_m, -0.01, 1e-9);
  EXPECT_EQ(at(on_cube(), 0.0, -0.01, false).surface.what, "cube");
  // In its middle, where it touches no face.
  EXPECT_NEAR(at(on_cube(), 0.0, -0.6, false).surface.distance_m, -0.6, 1e-9);
  EXPECT_NEAR(at(on_cube(), 0.3, -0.6, false).surface.distance_m, -0.3, 1e-9);
  // Beside it and below it.
  EXPECT_NEAR(at(on_cube(), 0.62, -0.6, false).surface.distance_m, 0.02, 1e-9);
  EXPECT_NEAR(at(on_cube(), 0.0, -1.25, false).surface.distance_m, 0.05, 1e-9);
  // Among thousands that are far away.
  World world = on_cube();
  for (int i = 1; i < 2000; ++i) {
    world.solids.push_back(world.solids[0]);
    world.solids.back().world_from_box.translation().x() += 3.0 * i;
  }
  EXPECT_NEAR(at(world, 0.3, -0.6, false).surface.distance_m, -0.3, 1e-9);
  EXPECT_NEAR(at(world, 3000.3, -0.6, false).surface.distance_m, -0.3, 1e-9);
}

TEST_F(BallAround, TouchesTheSolidThatItStandsOnAndNoOther) {
  const CollisionWorld::Surroundings above = at(on_cube(), 0.0, 0.0, true);
  EXPECT_EQ(above.touched.link, -1);
  EXPECT_GT(above.surface.distance_m, 0.1);
  const CollisionWorld::Surroundings sunk = at(on_cube(), 0.0, -0.01, true);
  EXPECT_NEAR(sunk.touched.distance_m, -0.01, 1e-9);
  EXPECT_EQ(sunk.touched.what, "cube");
  EXPECT_GT(sunk.surface.distance_m, 0.1);
  // What is exempted is no hole: the whole ball in the cube.
  EXPECT_NEAR(at(on_cube(), 0.0, -0.5, true).touched.distance_m, -0.5, 1e-9);
  // Beside the cube that it touches it is free.
  EXPECT_EQ(at(on_cube(), 0.65, -0.3, true).touched.link, -1);
  // A neighbour is in the way, whether it comes up beside the contact or lies below it.
  World world = on_cube();
  world.solids.push_back({.name = "next"});
  world.solids[1].world_from_box.translation() << 1.0, 0.0, -0.45;
  EXPECT_NEAR(at(world, 0.45, 0.0, true).surface.distance_m, std::hypot(0.05, 0.05) - 0.1, 1e-9);
  world.solids[1].world_from_box.translation().z() = -0.55;
  EXPECT_NEAR(at(world, 0.6, -0.06, true).surface.distance_m, -0.01, 1e-9);
}

TEST_F(BallAround, FarFacesOfTheSolidThatItTouchesAreStillInTheWay) {
  World world = on_cube();
  world.surfaces.push_back(world.surfaces[0]);
  Surface& front = world.surfaces[1];
  front.name = "cube front";
  front.world_from_surface.linear() << 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0;
  front.world_from_surface.translation() << 0.5, 0.0, -0.5;
  std::vector<Eigen::Isometry3d> poses(1, Eigen::Isometry3d::Identity());
  poses[0].translation() << 0.59, 0.0, -0.5;
  const auto around = [&](double x) {
    const CollisionWorld::Touch touch{.position = {x, 0.0, 0.0}, .surfaces = {0}, .links = {0}};
    return CollisionWorld(robot_, world)
        .surroundings({.world_from_link = poses, .touches = {&touch, 1}});
  };
  // 0.4 m from the contact, and 0.7 m.
  EXPECT_GT(around(0.4).surface.distance_m, 0.0);
  EXPECT_NEAR(around(0.4).touched.distance_m, -0.01, 1e-9);
  EXPECT_LT(around(-0.2).surface.distance_m, 0.0);
  EXPECT_EQ(around(-0.2).surface.what, "cube front");
}

TEST_F(BallAround, RefusesSolidsThatAreNone) {
  World world = on_cube();
  EXPECT_NO_THROW(CollisionWorld(robot_, world));
  world.solids[0].size_m.y() = 0.0;
  EXPECT_THROW(CollisionWorld(robot_, world), Error);
  world = on_cube();
  world.solids[0].world_from_box.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(CollisionWorld(robot_, world), Error);
}

TEST(SolidBox, KnowsItsFaces) {
  const World world = on_cube();
  Surface surface = world.surfaces[0];
  EXPECT_TRUE(is_part_of(world.solids[0], surface));
  surface.half_x_m = 0.51;
  EXPECT_FALSE(is_part_of(world.solids[0], surface));
  surface.half_x_m = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(is_part_of(world.solids[0], surface));
  surface = world.surfaces[0];
  surface.world_from_surface.translation().z() = 1e-6;
  EXPECT_FALSE(is_part_of(world.solids[0], surface));
}

TEST(DistanceView, TakesMapAndObstaclesAndLeavesOutTheGround) {
  std::vector<Box> boxes(2);
  boxes[0].world_from_box.translation().z() = -0.025;
  boxes[0].size << 2.0, 2.0, 0.04;
  boxes[1].world_from_box.translation() << 0.5, 0.0, 0.25;
  boxes[1].size << 0.1, 0.1, 0.5;
  World world{octree_from_boxes(boxes, 0.05), {}, {}, {}};
  EXPECT_LT(distance_view(world).distance({0.0, 0.0, 0.1}, 0.0), 0.11);
  world.surfaces = {ground()};
  EXPECT_EQ(ground_height(world), 0.0);
  EXPECT_GT(distance_view(world).distance({0.0, 0.0, 0.1}, 0.0), 0.3);
  world.map = nullptr;
  DistanceFieldOptions options;
  options.max_distance_m = 0.7;
  EXPECT_EQ(distance_view(world, options).distance({0.0, 0.0, 0.1}, 0.0), 0.7);
}

}  // namespace
}  // namespace locograph
