#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/world/perception/simulated_camera.h>

#include <cmath>

#include "world/perception/camera_support.h"

namespace locograph {
namespace {

using test::looking;
using test::TemporaryFolder;

struct SimulatedCameraTest : testing::Test {
  TemporaryFolder folder;
  Robot robot = test::robot_of_shapes(folder, R"(<cylinder radius="0.1" length="0.6"/>)");
  RobotState state{robot};
  World world;
  DepthCamera optics = test::small_camera(161, 121);

  SimulatedCameraTest() {
    world.surfaces = {ground()};
    optics.link_from_optical = looking({0.0, 0.0, 1.0}, 0.3);
  }
};

TEST_F(SimulatedCameraTest, WithoutNoiseTakesTheFirstHits) {
  SimulatedCamera camera(robot, world, CameraNoise::none());
  std::vector<std::int16_t> shows;
  const DepthImage image = camera.take(optics, 3, state, 0.25, 1, &shows);
  EXPECT_EQ(image.stamp_s, 0.25);
  EXPECT_EQ(image.camera, 3);
  ASSERT_EQ(image.depth_mm.size(), 161u * 121u);
  ASSERT_EQ(shows.size(), 161u * 121u);
  int floor = 0, arm = 0;
  for (int pixel = 0; pixel < 161 * 121; ++pixel) {
    const std::size_t at = static_cast<std::size_t>(pixel);
    const Shown shown = camera.shown(shows[at]);
    if (shown.kind == Shown::Kind::kLink) ++arm;
    if (shown.kind != Shown::Kind::kSurface) continue;
    ++floor;
    // 1 m below, by a ray that falls so fast: down the slope of the camera and of the pixel.
    const double y = (pixel / 161 - optics.cy) / optics.fy;
    const double fall = std::sin(0.3) + y * std::cos(0.3);
    EXPECT_NEAR(0.001 * image.depth_mm[at], 1.0 / fall, 0.00051) << pixel;
  }
  EXPECT_GT(floor, 5000);
  EXPECT_GT(arm, 100);
}

TEST_F(SimulatedCameraTest, IsTheSameForTheSameSeedCameraAndTime) {
  SimulatedCamera camera(robot, world), other(robot, world, {}, 3);
  const DepthImage image = camera.take(optics, 0, state, 0.5, 7);
  EXPECT_EQ(image.depth_mm, camera.take(optics, 0, state, 0.5, 7).depth_mm);
  EXPECT_EQ(image.depth_mm, other.take(optics, 0, state, 0.5, 7).depth_mm);
  EXPECT_NE(image.depth_mm, camera.take(optics, 1, state, 0.5, 7).depth_mm);
  EXPECT_NE(image.depth_mm, camera.take(optics, 0, state, 0.6, 7).depth_mm);
  EXPECT_NE(image.depth_mm, camera.take(optics, 0, state, 0.5, 8).depth_mm);
}

TEST_F(SimulatedCameraTest, MovesWithItsLink) {
  SimulatedCamera camera(robot, world, CameraNoise::none());
  const DepthImage low = camera.take(optics, 0, state, 0.0, 1);
  Eigen::VectorXd configuration = robot.neutral_configuration();
  configuration[2] = 1.0;
  state.update(configuration.data());
  const DepthImage high = camera.take(optics, 0, state, 0.0, 1);
  const std::size_t bottom = 120 * 161 + 5;
  EXPECT_NEAR(high.depth_mm[bottom], 2.0 * low.depth_mm[bottom], 2.0);
}

TEST_F(SimulatedCameraTest, TooNearIsNotSeenButShown) {
  optics.range_min_m = 2.5;
  SimulatedCamera camera(robot, world, CameraNoise::none());
  std::vector<std::int16_t> shows;
  const DepthImage image = camera.take(optics, 0, state, 0.0, 1, &shows);
  const std::size_t bottom = 120 * 161 + 80;
  EXPECT_EQ(image.depth_mm[bottom], 0);
  EXPECT_EQ(camera.shown(shows[bottom]).name, "ground");
}

TEST_F(SimulatedCameraTest, RefusesNoiseAndObstaclesThatAreNone) {
  EXPECT_THROW(SimulatedCamera(robot, world, {.lost = 2.0}), Error);
  EXPECT_THROW(SimulatedCamera(robot, world, {}, 0), Error);
  world.obstacles.emplace_back();  // without a size
  EXPECT_THROW(SimulatedCamera(robot, world), Error);
}

}  // namespace
}  // namespace locograph
