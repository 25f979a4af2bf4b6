// What is around a robot: obstacles, surfaces, and what its links may touch.
#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/robots/robot.h>
#include <locograph/world/collision_world.h>
#include <locograph/world/distance_view.h>
#include <locograph/world/octree.h>

#include "common/temporary_folder.h"

namespace locograph {
namespace {

/// A ball of 0.1 m radius, its centre 0.1 m + `height` above z = 0.
class BallAround : public ::testing::Test {
 protected:
  CollisionWorld::Surroundings at(const World& world, double x, double height, bool touches,
                                  std::vector<int> surfaces = {0}) const {
    std::vector<Eigen::Isometry3d> poses(1, Eigen::Isometry3d::Identity());
    poses[0].translation() << x, 0.0, 0.1 + height;
    const CollisionWorld::Touch touch{
        .position = {x, 0.0, 0.0}, .surfaces = std::move(surfaces), .links = {0}};
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
  world = {octree_from_boxes(boxes, 0.05), {}, {}};
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

TEST(DistanceView, TakesMapAndObstaclesAndLeavesOutTheGround) {
  std::vector<Box> boxes(2);
  boxes[0].world_from_box.translation().z() = -0.025;
  boxes[0].size << 2.0, 2.0, 0.04;
  boxes[1].world_from_box.translation() << 0.5, 0.0, 0.25;
  boxes[1].size << 0.1, 0.1, 0.5;
  World world{octree_from_boxes(boxes, 0.05), {}, {}};
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
