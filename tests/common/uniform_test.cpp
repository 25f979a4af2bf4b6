#include <gtest/gtest.h>
#include <locograph/common/uniform.h>

#include <algorithm>
#include <random>

namespace locograph {
namespace {

// The 10000th numbers that the standard gives for the engines (rand.predef).
TEST(Uniform, TakesTheUpper53BitsOf64) {
  std::mt19937_64 engine;
  engine.discard(9999);
  EXPECT_EQ(uniform(engine, 0.0, 1.0), 0x1.0p-53 * (9981545732273789042u >> 11));
}

TEST(Uniform, PutsTheSecondOfTwo32BitNumbersOnTop) {
  std::mt19937 engine;
  engine.discard(9998);
  std::mt19937 same = engine;
  const std::uint64_t below = same();
  const std::uint64_t bits = (std::uint64_t{4123659995u} << 32 | below) >> 11;
  EXPECT_EQ(uniform(engine, 0.0, 1.0), 0x1.0p-53 * static_cast<double>(bits));
  same();
  EXPECT_EQ(engine, same);  // two numbers are gone
}

TEST(Uniform, FillsItsRangeAndStaysInIt) {
  std::mt19937_64 engine(3);
  double lowest = 1e9, highest = -1e9, sum = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const double x = uniform(engine, -2.0, 6.0);
    lowest = std::min(lowest, x);
    highest = std::max(highest, x);
    sum += x;
  }
  EXPECT_GE(lowest, -2.0);
  EXPECT_LT(lowest, -1.99);
  EXPECT_LE(highest, 6.0);
  EXPECT_GT(highest, 5.99);
  EXPECT_NEAR(sum / 10000, 2.0, 0.1);
}

}  // namespace
}  // namespace locograph
