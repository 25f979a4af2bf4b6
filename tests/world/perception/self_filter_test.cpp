#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/common/uniform.h>
#include <locograph/world/perception/self_filter.h>
#include <locograph/world/perception/simulated_camera.h>

#include <cmath>
#include <random>

#include "world/perception/camera_support.h"

namespace locograph {
namespace {

using test::looking;
using test::TemporaryFolder;

/// A shipped robot in a random posture near home, with a camera that looks at its legs and arms.
struct Scene {
  Robot robot;
  RobotState state;
  DepthCamera camera = test::small_camera(320, 240);
  World world;

  explicit Scene(const std::string& name, double height_m = 0.0)
      : robot(test::shipped(name)), state(robot) {
    world.surfaces = {ground()};
    draw(0, height_m);
    if (name == "centauro") {
      camera.link = robot.link_index("pelvis");
      camera.link_from_optical = looking({0.38, 0.0, 0.8}, 1.0);
    } else {
      camera.link = robot.link_index("DWYTorso");
      camera.link_from_optical = looking({0.15, 0.0, 0.45}, 1.2);
    }
  }

  void draw(std::uint64_t seed, double height_m) {
    std::mt19937_64 random(seed);
    Eigen::VectorXd q = test::standing(robot, height_m);
    for (Eigen::Index i = 7; i < q.size(); ++i) q[i] += uniform(random, -0.4, 0.4);
    state.update(q.data());
  }

  bool is_robot(std::int16_t shows) const {
    return shows >= 0 && shows < static_cast<int>(robot.links().size());
  }
};

struct Robots : testing::TestWithParam<std::pair<const char*, double>> {};
INSTANTIATE_TEST_SUITE_P(Shipped, Robots,
                         testing::Values(std::pair("centauro", 0.8), std::pair("coman_plus", 1.0)));

TEST_P(Robots, PixelsAreThoseOfPointsInThePaddedCapsules) {
  Scene scene(GetParam().first);
  const SelfFilterOptions options{.padding_m = 0.03, .padding_per_m2 = 0.0, .edge_pixels = 0};
  SelfFilter filter(scene.robot, options);
  SimulatedCamera camera(scene.robot, scene.world);
  int robot_pixels = 0;
  for (int seed = 0; seed < 3; ++seed) {
    scene.draw(static_cast<std::uint64_t>(seed), GetParam().second);
    const DepthImage before = camera.take(scene.camera, 0, scene.state, 0.0, 1);
    DepthImage image = before, taken;
    filter.remove(scene.state, scene.camera, image, &taken);
    const Eigen::Isometry3d world_from_optical =
        scene.state.world_from_link(scene.camera.link) * scene.camera.link_from_optical;
    for (std::size_t pixel = 0; pixel < before.depth_mm.size(); ++pixel) {
      ASSERT_EQ(image.depth_mm[pixel] + taken.depth_mm[pixel], before.depth_mm[pixel]);
      ASSERT_TRUE(image.depth_mm[pixel] == 0 || taken.depth_mm[pixel] == 0);
      if (before.depth_mm[pixel] == 0 || (pixel % 3 != 0 && taken.depth_mm[pixel] == 0)) continue;
      const Eigen::Vector3d point =
          world_from_optical * Eigen::Vector3d(0.001 * before.depth_mm[pixel] *
                                               test::ray_of(scene.camera, static_cast<int>(pixel)));
      double out = std::numeric_limits<double>::infinity();
      for (const CollisionCapsule& capsule : filter.capsules()) {
        const Capsule there =
            transformed(scene.state.world_from_link(capsule.link), capsule.capsule);
        out = std::min(out, signed_distance(there, point) - 0.03);
      }
      robot_pixels += out <= 0.0;
      if (std::abs(out) > 1e-5) {
        ASSERT_EQ(taken.depth_mm[pixel] != 0, out <= 0.0) << pixel;
      }
    }
  }
  EXPECT_GT(robot_pixels, 1000);
}

TEST_P(Robots, NothingOfTheRobotStaysAndWhatIsFarFromItDoes) {
  Scene scene(GetParam().first);
  SelfFilter filter(scene.robot);
  SimulatedCamera camera(scene.robot, scene.world);
  CameraNoise steady;
  steady.flying_at_edge = 0.0;
  SimulatedCamera without_flying(scene.robot, scene.world, steady);
  int robot_pixels = 0, kept = 0, flying = 0, lost = 0, others = 0;
  for (int seed = 0; seed < 6; ++seed) {
    scene.draw(static_cast<std::uint64_t>(seed), GetParam().second);
    for (SimulatedCamera* simulated : {&camera, &without_flying}) {
      std::vector<std::int16_t> shows;
      DepthImage image = simulated->take(scene.camera, 0, scene.state, 0.0, 1, &shows);
      const DepthImage before = image;
      filter.remove(scene.state, scene.camera, image);
      for (std::size_t pixel = 0; pixel < shows.size(); ++pixel) {
        if (before.depth_mm[pixel] == 0) continue;
        const bool stays = image.depth_mm[pixel] != 0;
        if (!scene.is_robot(shows[pixel])) {
          ++others;
          lost += !stays;
        } else if (simulated == &camera) {
          flying += stays;
        } else {
          ++robot_pixels;
          kept += stays;
        }
      }
    }
  }
  EXPECT_GT(robot_pixels, 3000);
  EXPECT_EQ(kept, 0);
  // Those that fly by so far that the floor is near.
  EXPECT_LT(flying, 0.005 * robot_pixels);
  // The floor within reach of the feet and wheels, and at the silhouette.
  EXPECT_LT(lost, 0.05 * others);
}

TEST(SelfFilter, KeepsAnObstacleFiveCentimetresFromAShin) {
  Scene scene("coman_plus", 1.0);
  // A ball of 4 cm beside the left shin.
  const Eigen::Isometry3d shin = scene.state.world_from_link(scene.robot.link_index("LLowLeg"));
  SelfFilter filter(scene.robot);
  Obstacle ball;
  ball.shape = Obstacle::Shape::kSphere;
  ball.size = Eigen::Vector3d(0.04, 0.0, 0.0);
  for (double out = 0.05; ball.world_from_obstacle.translation().isZero(); out += 0.001) {
    const Eigen::Vector3d at = shin * Eigen::Vector3d(out, 0.0, -0.15);
    double distance = std::numeric_limits<double>::infinity();
    for (const CollisionCapsule& capsule : filter.capsules()) {
      const Capsule there = transformed(scene.state.world_from_link(capsule.link), capsule.capsule);
      distance = std::min(distance, signed_distance(there, at));
    }
    if (distance >= 0.09) ball.world_from_obstacle.translation() = at;
  }
  scene.world.obstacles = {ball};
  scene.camera = test::small_camera(640, 480);
  scene.camera.link = scene.robot.link_index("DWYTorso");
  scene.camera.link_from_optical = looking({0.5, 0.1, -0.1}, 1.4);
  SimulatedCamera camera(scene.robot, scene.world);
  const std::int16_t shown_ball = static_cast<std::int16_t>(scene.robot.links().size());
  std::vector<std::int16_t> shows;
  DepthImage image = camera.take(scene.camera, 0, scene.state, 0.0, 1, &shows);
  const DepthImage before = image;
  filter.remove(scene.state, scene.camera, image);
  int seen = 0, kept = 0;
  for (std::size_t pixel = 0; pixel < shows.size(); ++pixel) {
    if (shows[pixel] != shown_ball || before.depth_mm[pixel] == 0) continue;
    ++seen;
    kept += image.depth_mm[pixel] != 0;
  }
  EXPECT_GT(seen, 100);
  EXPECT_GE(kept, 0.99 * seen);
}

TEST(SelfFilter, PadsEachLinkByItsOwn) {
  const TemporaryFolder folder;
  const Robot robot = test::robot_of_shapes(folder, R"(<sphere radius="0.1"/>)");
  const RobotState state(robot);
  DepthCamera camera = test::small_camera(33, 25);  // no whole tiles
  const Capsule ball = transformed(state.world_from_link(robot.link_index("arm")),
                                   covering_capsules(robot)[0].capsule);
  camera.link_from_optical = looking(ball.from - Eigen::Vector3d(1.0, 0.0, 0.0), 0.0);
  const std::size_t middle = 12 * 33 + 16;
  const auto stays = [&](const SelfFilterOptions& options, int depth_mm) {
    DepthImage image{.width = 33, .height = 25, .depth_mm = std::vector<std::uint16_t>(33 * 25)};
    image.depth_mm[middle] = static_cast<std::uint16_t>(depth_mm);
    SelfFilter(robot, options).remove(state, camera, image);
    return image.depth_mm[middle] != 0;
  };
  const SelfFilterOptions plain{.padding_m = 0.02, .padding_per_m2 = 0.0};
  EXPECT_TRUE(stays(plain, 878));
  EXPECT_FALSE(stays(plain, 882));
  EXPECT_FALSE(stays(plain, 1118));
  EXPECT_TRUE(stays(plain, 1122));
  const SelfFilterOptions thick{
      .padding_m = 0.02, .link_padding_m = {{"arm", 0.05}}, .padding_per_m2 = 0.0};
  EXPECT_TRUE(stays(thick, 848));
  EXPECT_FALSE(stays(thick, 852));
  // At a depth of 1.1 m another 0.01 * 1.1^2.
  const SelfFilterOptions growing{.padding_m = 0.02, .padding_per_m2 = 0.01};
  EXPECT_TRUE(stays(growing, 866));
  EXPECT_FALSE(stays(growing, 869));
}

TEST(SelfFilter, TakesWhatFliesBesideTheRobotAndNoMore) {
  const TemporaryFolder folder;
  const Robot robot = test::robot_of_shapes(folder, R"(<sphere radius="0.1"/>)");
  const RobotState state(robot);
  DepthCamera camera = test::small_camera();
  const Capsule ball = transformed(state.world_from_link(robot.link_index("arm")),
                                   covering_capsules(robot)[0].capsule);
  camera.link_from_optical = looking(ball.from - Eigen::Vector3d(1.0, 0.0, 0.0), 0.0);
  // The ball in front of a wall, and in its middle row a pixel that flies on its left, one that
  // flies far from it, and a pole of two pixels right beside it.
  SimulatedCamera simulated(robot, {}, CameraNoise::none());
  std::vector<std::int16_t> shows;
  DepthImage image = simulated.take(camera, 0, state, 0.0, 1, &shows);
  for (std::uint16_t& depth : image.depth_mm) depth = depth == 0 ? 3000 : depth;
  const int row = 60 * camera.width;
  int left = row, right = row + camera.width - 1;
  while (shows[static_cast<std::size_t>(left)] < 0) ++left;
  while (shows[static_cast<std::size_t>(right)] < 0) --right;
  image.depth_mm[static_cast<std::size_t>(left) - 1] = 1700;
  image.depth_mm[static_cast<std::size_t>(left) - 9] = 1700;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 1; u <= 2; ++u)
      image.depth_mm[static_cast<std::size_t>(v * camera.width + right - row + u)] = 1500;
  }
  SelfFilter(robot).remove(state, camera, image);
  for (int pixel = left; pixel <= right; ++pixel)
    EXPECT_EQ(image.depth_mm[static_cast<std::size_t>(pixel)], 0);
  EXPECT_EQ(image.depth_mm[static_cast<std::size_t>(left) - 1], 0);
  EXPECT_EQ(image.depth_mm[static_cast<std::size_t>(left) - 9], 1700);
  EXPECT_EQ(image.depth_mm[static_cast<std::size_t>(left) - 2], 3000);
  EXPECT_EQ(image.depth_mm[static_cast<std::size_t>(right) + 1], 1500);
  EXPECT_EQ(image.depth_mm[static_cast<std::size_t>(right) + 2], 1500);
}

TEST(SelfFilter, RefusesWhatDoesNotBelongTogether) {
  const TemporaryFolder folder;
  const Robot robot = test::robot_of_shapes(folder, R"(<sphere radius="0.1"/>)");
  const RobotState state(robot);
  EXPECT_THROW(SelfFilter(robot, {.padding_m = -0.1}), Error);
  EXPECT_THROW(SelfFilter(robot, {.link_padding_m = {{"leg", 0.1}}}), Error);
  EXPECT_THROW(SelfFilter(robot, {.link_padding_m = {{"arm", 0.1}, {"arm", 0.2}}}), Error);
  EXPECT_THROW(SelfFilter(robot, {.padding_per_m2 = NAN}), Error);
  EXPECT_THROW(SelfFilter(robot, {.edge_pixels = -1}), Error);
  SelfFilter filter(robot);
  DepthCamera camera = test::small_camera(32, 24);
  DepthImage image{.width = 32, .height = 24, .depth_mm = std::vector<std::uint16_t>(32 * 24, 500)};
  EXPECT_NO_THROW(filter.remove(state, camera, image));
  image.depth_mm.pop_back();
  EXPECT_THROW(filter.remove(state, camera, image), Error);
  image.depth_mm.push_back(500);
  camera.link = 5;
  EXPECT_THROW(filter.remove(state, camera, image), Error);
  camera.link = 0;
  camera.width = 24;
  EXPECT_THROW(filter.remove(state, camera, image), Error);
}

}  // namespace
}  // namespace locograph
