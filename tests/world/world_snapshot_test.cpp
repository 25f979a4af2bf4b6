#include <gtest/gtest.h>
#include <locograph/world/distance_view.h>
#include <locograph/world/octree.h>
#include <locograph/world/world_snapshot.h>
#include <locograph/world/world_solids.h>

#include <array>
#include <thread>
#include <vector>

namespace locograph {
namespace {

/// A box of voxels, and a ball beside it.
World box_and_ball() {
  Box box;
  box.world_from_box.translation() << 1.0, 0.0, 0.25;
  box.size << 0.5, 0.5, 0.5;
  Obstacle ball;
  ball.name = "ball";
  ball.shape = Obstacle::Shape::kSphere;
  ball.size[0] = 0.2;
  ball.world_from_obstacle.translation() << 0.0, 1.5, 0.2;
  World world;
  world.map = octree_from_boxes({&box, 1}, 0.05);
  world.obstacles = {ball};
  world.surfaces = {ground()};
  return world;
}

TEST(WorldSnapshot, IsWhatItWasMadeOf) {
  const World world = box_and_ball();
  const WorldSnapshot snapshot(world, 12.5, {.map = "hall.bt", .obstacles = {}});
  EXPECT_EQ(snapshot.stamp_s(), 12.5);
  EXPECT_EQ(snapshot.files().map, "hall.bt");
  EXPECT_TRUE(snapshot.files().obstacles.empty());
  EXPECT_EQ(snapshot.world().map, world.map);
  ASSERT_EQ(snapshot.world().obstacles.size(), 1u);
  EXPECT_EQ(snapshot.world().obstacles[0].name, "ball");
}

TEST(WorldSnapshot, ShowsEdgesTheDistanceViewOfItsOptions) {
  DistanceFieldOptions options;
  options.max_distance_m = 0.4;
  options.ground_z = 0.1;
  const WorldDistance expected = distance_view(box_and_ball(), options);
  const WorldSnapshot snapshot(box_and_ball(), 0.0, {}, options);
  for (const double x : {0.2, 0.5, 0.7, 1.0}) {
    for (const double z : {0.05, 0.2, 0.6}) {
      const Eigen::Vector3d point(x, 0.3, z);
      EXPECT_EQ(snapshot.distance().distance(point, 0.0), expected.distance(point, 0.0));
    }
  }
}

TEST(WorldSnapshot, RefusesOptionsOutOfRange) {
  DistanceFieldOptions options;
  options.max_distance_m = -1.0;
  EXPECT_THROW(WorldSnapshot(World(), 0.0, {}, options), Error);
}

TEST(WorldSnapshot, TellsAViewThatCannotBeMadeWhoeverAsksForIt) {
  World world;
  world.surfaces = {ground()};
  world.surfaces[0].half_x_m = -1.0;
  const WorldSnapshot snapshot(world);
  EXPECT_THROW(snapshot.solids(), Error);
  EXPECT_THROW(snapshot.solids(), Error);
  EXPECT_NO_THROW(snapshot.distance());
}

TEST(WorldSnapshot, MakesEachViewOnceHoweverManyThreadsAskForIt) {
  const WorldSnapshot snapshot(box_and_ball());
  std::array<const WorldDistance*, 4> distances{};
  std::array<std::shared_ptr<const WorldSolids>, 4> solids;
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < distances.size(); ++i) {
      threads.emplace_back([&, i] {
        solids[i] = snapshot.solids();
        distances[i] = &snapshot.distance();
      });
    }
  }
  for (std::size_t i = 0; i < distances.size(); ++i) {
    EXPECT_EQ(distances[i], &snapshot.distance());
    EXPECT_EQ(solids[i], snapshot.solids());
  }
  EXPECT_TRUE(solids[0]->voxels);
  EXPECT_EQ(solids[0]->obstacle_shapes.size(), 1u);
  EXPECT_EQ(solids[0]->ground_z, 0.0);
}

}  // namespace
}  // namespace locograph
