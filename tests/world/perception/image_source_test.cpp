#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/world/perception/image_source.h>

#include <algorithm>
#include <cmath>

#include "world/perception/small_camera_robot.h"

namespace locograph {
namespace {

using test::camera_robot;
using test::small_camera;
using test::standing_at;

/// A wall at x = 2 that is there from 0.05 s on.
World passing_wall() {
  Obstacle wall;
  wall.name = "wall";
  wall.size << 0.2, 8.0, 8.0;
  wall.world_from_obstacle.translation() << 2.1, 0.0, 1.0;
  wall.appears_s = 0.05;
  World world;
  world.obstacles = {wall};
  return world;
}

struct Taking {
  std::shared_ptr<const Robot> robot = camera_robot();
  std::vector<DepthCamera> cameras = {small_camera(*robot), small_camera(*robot)};
  RobotState state{*robot};

  Taking() {
    cameras[1].name = "other";
    state.update(standing_at(*robot, 0.0).data());
  }
  SimulatedImages images(const SimulatedImagesOptions& options = {}) const {
    return SimulatedImages(robot, passing_wall(), cameras, options);
  }
};

TEST(SimulatedImages, ComeFromAllCamerasInTheOrderOfTheirStamps) {
  Taking taking;
  SimulatedImages images = taking.images({.rate_hz = 20.0, .begin_s = -0.1});
  for (int k = 0; k < 8; ++k) {
    const double stamp_s = images.next_stamp_s();
    const DepthImage image = images.take(taking.state);
    EXPECT_DOUBLE_EQ(stamp_s, -0.1 + 0.05 * (k / 2));
    EXPECT_EQ(image.stamp_s, stamp_s);
    EXPECT_EQ(image.camera, k % 2);
    EXPECT_EQ(image.width, test::kWidth);
  }
}

TEST(SimulatedImages, ShowAnObstacleOnceItIsThere) {
  Taking taking;
  SimulatedImages images =
      taking.images({.rate_hz = 100.0, .begin_s = 0.005, .noise = CameraNoise::none()});
  const auto middle = [](const DepthImage& image) {
    return image
        .depth_mm[static_cast<std::size_t>(test::kHeight / 2 * test::kWidth + test::kWidth / 2)];
  };
  for (int k = 0; k < 20; ++k) {
    const double stamp_s = images.next_stamp_s();
    EXPECT_EQ(middle(images.take(taking.state)), stamp_s < 0.05 ? 0 : 2000) << stamp_s;
  }
}

TEST(SimulatedImages, AreTheSameForTheSameSeedAndOthersForAnother) {
  Taking taking;
  const auto all = [&](std::uint64_t seed) {
    SimulatedImages images = taking.images({.rate_hz = 10.0, .begin_s = 1.0, .seed = seed});
    std::vector<std::uint16_t> depths;
    for (int k = 0; k < 4; ++k) {
      const DepthImage image = images.take(taking.state);
      depths.insert(depths.end(), image.depth_mm.begin(), image.depth_mm.end());
    }
    return depths;
  };
  EXPECT_EQ(all(1), all(1));
  EXPECT_NE(all(1), all(2));
}

TEST(SimulatedImages, RefuseRatesAndCamerasThatMakeNoSense) {
  const Taking taking;
  EXPECT_THROW(taking.images({.rate_hz = 0.0}), Error);
  EXPECT_THROW(taking.images({.rate_hz = std::nan("")}), Error);
  EXPECT_THROW(taking.images({.begin_s = std::nan("")}), Error);
  EXPECT_THROW(SimulatedImages(taking.robot, World(), {}), Error);
}

}  // namespace
}  // namespace locograph
