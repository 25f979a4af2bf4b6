#include <gtest/gtest.h>
#include <locograph/planners/online/incumbent.h>

namespace locograph {
namespace incumbent_test {

using State = std::vector<double>;

constexpr int kSteps = 5;

/// ratio: of the worst violation; up to 1 nothing is violated.
WindowQuality quality(int feasible_steps, double ratio, double cost = 1.0) {
  WindowQuality result;
  result.steps = kSteps;
  result.feasible_steps = feasible_steps;
  result.worst.ratio = ratio;
  result.cost = cost;
  return result;
}

TEST(Incumbent, TakesTheFirstWindowWhateverItIs) {
  Incumbent incumbent;
  EXPECT_TRUE(incumbent.best().state.empty());
  EXPECT_TRUE(incumbent.offer(quality(0, 100.0), {1.0}));
  EXPECT_EQ(incumbent.best().state, State{1.0});
}

TEST(Incumbent, IsOnlyReplacedByABetterWindow) {
  Incumbent incumbent;
  incumbent.offer(quality(3, 5.0), {1.0});
  EXPECT_FALSE(incumbent.offer(quality(2, 2.0), {2.0})) << "holds for fewer steps";
  EXPECT_EQ(incumbent.best().state, State{1.0});
  EXPECT_TRUE(incumbent.offer(quality(3, 4.0), {3.0})) << "violates less";
  EXPECT_TRUE(incumbent.offer(quality(kSteps, 0.5, 9.0), {4.0})) << "feasible";
  EXPECT_FALSE(incumbent.offer(quality(4, 1.5, 0.1), {5.0})) << "cheap, but infeasible";
  EXPECT_FALSE(incumbent.offer(quality(kSteps, 0.1, 9.0), {6.0})) << "costs as much";
  EXPECT_TRUE(incumbent.offer(quality(kSteps, 0.9, 8.0), {7.0})) << "costs less";
  EXPECT_EQ(incumbent.best().state, State{7.0});
  EXPECT_EQ(incumbent.best().quality.cost, 8.0);
}

TEST(Incumbent, RemembersTheLeastViolatingWindowBesideTheBest) {
  Incumbent incumbent;
  incumbent.offer(quality(3, 5.0), {1.0});
  incumbent.offer(quality(2, 2.0), {2.0});
  incumbent.offer(quality(4, 3.0), {3.0});
  EXPECT_EQ(incumbent.best().state, State{3.0});
  EXPECT_EQ(incumbent.least_violating().state, State{2.0});
}

TEST(Incumbent, ForgetsTheLastCycle) {
  Incumbent incumbent;
  incumbent.offer(quality(kSteps, 0.0), {1.0});
  incumbent.clear();
  EXPECT_TRUE(incumbent.best().state.empty());
  EXPECT_TRUE(incumbent.offer(quality(1, 9.0), {2.0}));
  EXPECT_EQ(incumbent.least_violating().state, State{2.0});
}

TEST(Incumbent, HasNothingUnfinishedWhereItIsFeasibleAndNothingWasCutShort) {
  Incumbent incumbent;
  incumbent.offer(quality(kSteps, 0.5), {1.0});
  incumbent.offer(quality(kSteps, 0.1, 2.0), {2.0});
  EXPECT_EQ(incumbent.unfinished(nullptr), nullptr);
}

TEST(Incumbent, LeavesTheLeastViolatingWindowUnfinishedWhileItIsInfeasible) {
  Incumbent incumbent;
  incumbent.offer(quality(3, 2.0), {1.0});
  EXPECT_EQ(incumbent.unfinished(nullptr), nullptr) << "the best one itself";
  incumbent.offer(quality(4, 3.0), {2.0});
  ASSERT_NE(incumbent.unfinished(nullptr), nullptr);
  EXPECT_EQ(*incumbent.unfinished(nullptr), State{1.0});
}

TEST(Incumbent, LeavesTheStateUnfinishedInWhichTheDeadlineCutARunShort) {
  Incumbent incumbent;
  incumbent.offer(quality(kSteps, 0.5), {1.0});
  const State best{1.0}, other{2.0};
  EXPECT_EQ(incumbent.unfinished(&best), nullptr);
  EXPECT_EQ(incumbent.unfinished(&other), &other);
}

}  // namespace incumbent_test
}  // namespace locograph
