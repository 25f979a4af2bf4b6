#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/world/perception/camera_noise.h>

#include <cmath>
#include <limits>
#include <set>

#include "world/perception/camera_support.h"

namespace locograph {
namespace {

constexpr int kWidth = 160, kHeight = 120, kPixels = kWidth * kHeight;
constexpr float kNothing = std::numeric_limits<float>::infinity();

DepthImage noisy(const CameraNoise& noise, const std::vector<float>& depth_m,
                 std::uint64_t seed = 1) {
  DepthImage image;
  add_noise(noise, test::small_camera(kWidth, kHeight), seed, depth_m, image);
  EXPECT_EQ(image.width, kWidth);
  EXPECT_EQ(image.height, kHeight);
  EXPECT_EQ(image.depth_mm.size(), static_cast<std::size_t>(kPixels));
  return image;
}

std::vector<float> wall(double depth_m) {
  return std::vector<float>(kPixels, static_cast<float>(depth_m));
}

/// Left half near, right half far.
std::vector<float> step(float near_m, float far_m) {
  std::vector<float> depth(kPixels);
  for (int pixel = 0; pixel < kPixels; ++pixel)
    depth[static_cast<std::size_t>(pixel)] = pixel % kWidth < kWidth / 2 ? near_m : far_m;
  return depth;
}

int count(const DepthImage& image, int depth_mm) {
  return static_cast<int>(std::ranges::count(image.depth_mm, depth_mm));
}

TEST(CameraNoise, NoneRoundsToMillimetres) {
  std::vector<float> depth = step(1.2344f, 2.5676f);
  depth[0] = kNothing;
  const DepthImage image = noisy(CameraNoise::none(), depth);
  EXPECT_EQ(image.depth_mm[0], 0);
  EXPECT_EQ(count(image, 1234), kPixels / 2 - 1);
  EXPECT_EQ(count(image, 2568), kPixels / 2);
}

TEST(CameraNoise, GrowsWithTheSquareOfTheDepth) {
  CameraNoise noise = CameraNoise::none();
  noise.at_zero_m = 0.001;
  noise.per_m2 = 0.004;
  for (const double depth : {0.5, 2.0, 4.0}) {
    const DepthImage image = noisy(noise, wall(depth));
    double sum = 0.0, squares = 0.0, most = 0.0;
    for (const int depth_mm : image.depth_mm) {
      const double error = 0.001 * depth_mm - depth;
      sum += error;
      squares += error * error;
      most = std::max(most, std::abs(error));
    }
    const double deviation = 0.001 + 0.004 * depth * depth;
    EXPECT_NEAR(sum / kPixels, 0.0, 4.0 * deviation / std::sqrt(kPixels));
    EXPECT_NEAR(std::sqrt(squares / kPixels), deviation, 0.02 * deviation);
    EXPECT_LE(most, 2.0 * std::sqrt(3.0) * deviation + 0.0005001);
  }
}

TEST(CameraNoise, LosesPixelsAndSquares) {
  CameraNoise noise = CameraNoise::none();
  noise.lost = 0.1;
  EXPECT_NEAR(count(noisy(noise, wall(1.0)), 0), 0.1 * kPixels, 150);
  noise.lost = 0.0;
  noise.lost_squares = 0.2;
  const DepthImage image = noisy(noise, wall(1.0));
  EXPECT_NEAR(count(image, 0), 0.2 * kPixels, 800);
  for (int pixel = 0; pixel < kPixels; ++pixel) {
    const int u = pixel % kWidth / 8 * 8, v = pixel / kWidth / 8 * 8;
    EXPECT_EQ(image.depth_mm[static_cast<std::size_t>(pixel)],
              image.depth_mm[static_cast<std::size_t>(v * kWidth + u)]);
  }
}

TEST(CameraNoise, FliesBetweenTheDepthsOfAnEdge) {
  CameraNoise noise = CameraNoise::none();
  noise.flying_at_edge = 0.5;
  noise.lost_at_edge = 0.25;
  const DepthImage image = noisy(noise, step(1.0f, 2.0f));
  int flying = 0;
  std::set<int> depths;
  for (int pixel = 0; pixel < kPixels; ++pixel) {
    const int u = pixel % kWidth, depth = image.depth_mm[static_cast<std::size_t>(pixel)];
    const bool at_edge = u == kWidth / 2 - 1 || u == kWidth / 2;
    if (!at_edge) {
      EXPECT_EQ(depth, u < kWidth / 2 ? 1000 : 2000);
      continue;
    }
    if (depth == 0) continue;
    EXPECT_GE(depth, 1000);
    EXPECT_LE(depth, 2000);
    flying += depth != 1000 && depth != 2000;
    depths.insert(depth);
  }
  EXPECT_NEAR(flying, 0.5 * 2 * kHeight, 25);
  EXPECT_NEAR(count(image, 0), 0.25 * 2 * kHeight, 25);
  EXPECT_GT(depths.size(), 50u);
  // A floor that is seen at a flat angle is no edge, nor is the end of the range.
  EXPECT_EQ(count(noisy(noise, step(1.0f, 1.04f)), 1000), kPixels / 2);
}

TEST(CameraNoise, ShadowsAreWhatTheSecondImagerDoesNotSee) {
  CameraNoise noise = CameraNoise::none();
  noise.baseline_m = 0.05;
  const double disparity = test::small_camera(kWidth, kHeight).fx * 0.05;  // pixels at 1 m
  // A bar of 20 pixels at 0.5 m in front of a wall at 2 m.
  std::vector<float> depth = wall(2.0);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 80; u < 100; ++u) depth[static_cast<std::size_t>(v * kWidth + u)] = 0.5f;
  }
  const DepthImage image = noisy(noise, depth);
  for (int u = 0; u < kWidth; ++u) {
    const int seen = image.depth_mm[static_cast<std::size_t>(30 * kWidth + u)];
    // Of the wall, the columns u whose u - d / 2 is among those of the bar, 80 - 2 d to 99 - 2 d.
    const bool out = u - 0.5 * disparity < -0.5;
    const bool hidden = u < 80 && u - 0.5 * disparity >= 80 - 2.0 * disparity;
    EXPECT_EQ(seen, out || hidden ? 0 : u >= 80 && u < 100 ? 500 : 2000) << u;
  }
}

TEST(CameraNoise, BeyondTheRangeNothingIsSeen) {
  EXPECT_EQ(count(noisy(CameraNoise::none(), step(0.29f, 0.31f)), 310), kPixels / 2);
  EXPECT_EQ(count(noisy(CameraNoise::none(), step(0.29f, 0.31f)), 0), kPixels / 2);
  EXPECT_EQ(count(noisy(CameraNoise::none(), step(5.99f, 6.01f)), 0), kPixels / 2);
  const DepthImage image = noisy({}, step(0.31f, 5.95f));
  for (const int depth : image.depth_mm) EXPECT_TRUE(depth == 0 || (depth >= 300 && depth <= 6000));
}

TEST(CameraNoise, IsThatOfTheSeed) {
  EXPECT_EQ(noisy({}, wall(2.0), 5).depth_mm, noisy({}, wall(2.0), 5).depth_mm);
  EXPECT_NE(noisy({}, wall(2.0), 5).depth_mm, noisy({}, wall(2.0), 6).depth_mm);
  const std::set<std::uint64_t> seeds = {noise_seed(1, 0, 0.0), noise_seed(1, 1, 0.0),
                                         noise_seed(1, 0, 0.1), noise_seed(2, 0, 0.0)};
  EXPECT_EQ(seeds.size(), 4u);
  EXPECT_EQ(noise_seed(1, 0, 0.0), noise_seed(1, 0, -0.0));
}

TEST(CameraNoise, RefusesWhatIsNone) {
  const auto refused = [](auto change) {
    CameraNoise noise;
    change(noise);
    EXPECT_THROW(noise.validate(), Error);
  };
  refused([](CameraNoise& n) { n.per_m2 = -1.0; });
  refused([](CameraNoise& n) { n.at_zero_m = NAN; });
  refused([](CameraNoise& n) { n.lost = 1.5; });
  refused([](CameraNoise& n) { n.lost_squares = -0.1; });
  refused([](CameraNoise& n) { n.edge = 0.0; });
  refused([](CameraNoise& n) { n.flying_at_edge = 0.9; });
  refused([](CameraNoise& n) { n.baseline_m = INFINITY; });
  EXPECT_NO_THROW(CameraNoise().validate());
  EXPECT_NO_THROW(CameraNoise::none().validate());
  DepthImage image;
  EXPECT_THROW(add_noise({}, test::small_camera(), 0, std::vector<float>(7), image), Error);
}

}  // namespace
}  // namespace locograph
