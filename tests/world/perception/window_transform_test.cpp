// Exact squared distances in a window, against brute force, at every level of vector instructions.
#include <gtest/gtest.h>
#include <locograph/common/simd_level.h>
#include <locograph/world/perception/window_transform.h>

#include <algorithm>
#include <random>
#include <tuple>
#include <vector>

namespace locograph {
namespace {

constexpr int kCap = 9;
constexpr ObstacleRange kObstacles{20, 107};

struct Pattern {
  VoxelWindow window{.resolution_m = 0.05, .size = {64, 17, 13}};
  std::vector<std::int8_t> log_odds;

  Pattern() : log_odds(window.count(), 0) {}

  template <class Visit>
  void each(Visit visit) const {
    for (int z = 0; z < window.size[2]; ++z)
      for (int y = 0; y < window.size[1]; ++y)
        for (int x = 0; x < window.size[0]; ++x) visit(Eigen::Vector3i(x, y, z));
  }
  std::int8_t& at(const Eigen::Vector3i& in_window) {
    return log_odds[window.stored(window.first + in_window)];
  }
};

/// How many voxels are not as brute force has them.
int differences(Pattern& pattern, const WindowTransform& transform, bool outside_is_obstacle) {
  std::vector<Eigen::Vector3i> obstacles;
  pattern.each([&](const Eigen::Vector3i& at) {
    if (kObstacles.holds(pattern.at(at))) obstacles.push_back(at);
  });
  const Eigen::Vector3i& size = pattern.window.size;
  int different = 0;
  pattern.each([&](const Eigen::Vector3i& at) {
    int least = kCap * kCap + 1;
    for (const Eigen::Vector3i& obstacle : obstacles)
      least = std::min(least, (obstacle - at).squaredNorm());
    for (int axis = 0; axis < 3 && outside_is_obstacle; ++axis) {
      const int out = std::min(at[axis] + 1, size[axis] - at[axis]);
      least = std::min(least, out * out);
    }
    different += transform.squared()[pattern.window.stored(pattern.window.first + at)] != least;
  });
  return different;
}

class WindowTransformTest : public testing::TestWithParam<std::tuple<std::string, bool>> {
 protected:
  const bool outside_is_obstacle_ = std::get<1>(GetParam());
  Pattern pattern_;
  WindowTransform transform_{pattern_.window, kCap, kObstacles, outside_is_obstacle_,
                             window_kernels_at(std::get<0>(GetParam()))};
  std::mt19937 generator_{3};

  void scatter(double density) {
    std::bernoulli_distribution occupied(density);
    for (std::int8_t& value : pattern_.log_odds) value = occupied(generator_) ? 30 : -20;
  }
};
INSTANTIATE_TEST_SUITE_P(Levels, WindowTransformTest,
                         testing::Combine(testing::ValuesIn(simd_levels()), testing::Bool()),
                         [](const auto& test) {
                           return std::get<0>(test.param) +
                                  (std::get<1>(test.param) ? "_closed" : "_open");
                         });

TEST_P(WindowTransformTest, EqualsBruteForceWhereverTheRingsAre) {
  std::uniform_int_distribution<int> steps(-9, 9);
  for (const double density : {0.0, 0.0001, 0.001, 0.01, 0.1, 1.0}) {
    pattern_.window.place({8 * steps(generator_), 8 * steps(generator_), 8 * steps(generator_)});
    scatter(density);
    transform_.change_everything();
    transform_.update(pattern_.window, pattern_.log_odds);
    EXPECT_EQ(differences(pattern_, transform_, outside_is_obstacle_), 0) << density;
  }
}

TEST_P(WindowTransformTest, FollowsSingleVoxels) {
  pattern_.window.place({40, -16, 8});
  scatter(0.002);
  transform_.update(pattern_.window, pattern_.log_odds);
  std::uniform_int_distribution<std::size_t> any(0, pattern_.log_odds.size() - 1);
  for (int round = 0; round < 20; ++round) {
    for (int i = 0; i < round; ++i) {
      const std::size_t at = any(generator_);
      std::int8_t& value = pattern_.log_odds[at];
      value = kObstacles.holds(value) ? -20 : 30;
      const std::size_t row = at / 64 % 17, block = at % 64 / kVoxelBlock;
      transform_.changed()[2 * row + block] = 1;
    }
    transform_.update(pattern_.window, pattern_.log_odds);
    ASSERT_EQ(differences(pattern_, transform_, outside_is_obstacle_), 0) << round;
  }
}

TEST(VoxelWindow, StoresEachVoxelAtOnePlace) {
  VoxelWindow window{.resolution_m = 0.1, .size = {32, 5, 7}};
  window.place({-48, 13, -3});
  std::vector<int> times(window.count(), 0);
  for (int z = -3; z < 4; ++z)
    for (int y = 13; y < 18; ++y)
      for (int x = -48; x < -16; ++x) {
        ASSERT_TRUE(window.contains({x, y, z}));
        ++times[window.stored({x, y, z})];
      }
  EXPECT_EQ(std::ranges::count(times, 1), static_cast<long>(window.count()));
  EXPECT_FALSE(window.contains({-49, 13, -3}));
  EXPECT_FALSE(window.contains({-48, 18, -3}));
  EXPECT_EQ(window.index_at({-4.75, 1.35, -0.25}), Eigen::Vector3i(-48, 13, -3));
}

}  // namespace
}  // namespace locograph
