// Programmes whose corners are known by hand.
#include <gtest/gtest.h>
#include <locograph/planners/balance/linear_programme.h>

namespace locograph::linear_programme_test {
namespace {

/// x and y from 0 on with x + 2 y at most 4 and 3 x + y at most 6; its corner is (1.6, 1.2).
LinearProgramme two_limits(double cost_of_x, double cost_of_y) {
  LinearColumns columns;
  columns.put(0, 1.0);
  columns.put(1, 3.0);
  columns.end(0.0, kNoBound, cost_of_x);
  columns.put(0, 2.0);
  columns.put(1, 1.0);
  columns.end(0.0, kNoBound, cost_of_y);
  LinearProgramme programme(LinearProgramme::Perturbation::kNone);
  programme.load(columns, {-kNoBound, -kNoBound}, {4.0, 6.0});
  return programme;
}

TEST(LinearProgramme, FindsTheCornerOfLeastCostEitherWay) {
  for (const auto run : {&LinearProgramme::primal, &LinearProgramme::dual}) {
    LinearProgramme programme = two_limits(-1.0, -1.0);
    ASSERT_EQ((programme.*run)(), LinearAnswer::kOptimal);
    ASSERT_EQ(programme.solution().size(), 2U);
    EXPECT_NEAR(programme.solution()[0], 1.6, 1e-9);
    EXPECT_NEAR(programme.solution()[1], 1.2, 1e-9);
    EXPECT_NEAR(programme.value(), -2.8, 1e-9);
  }
}

TEST(LinearProgramme, PricesSayWhatABoundIsWorth) {
  LinearProgramme programme = two_limits(-1.0, -1.0);
  ASSERT_EQ(programme.primal(), LinearAnswer::kOptimal);
  ASSERT_EQ(programme.prices().size(), 2U);
  EXPECT_NEAR(programme.prices()[0], -0.4, 1e-9);
  EXPECT_NEAR(programme.prices()[1], -0.2, 1e-9);
}

TEST(LinearProgramme, GoesOnFromTheLastCornerWithOtherCostsAndEntries) {
  LinearProgramme programme = two_limits(-1.0, -1.0);
  ASSERT_EQ(programme.primal(), LinearAnswer::kOptimal);
  programme.set_cost(1, 1.0);
  ASSERT_EQ(programme.primal(), LinearAnswer::kOptimal);
  EXPECT_NEAR(programme.solution()[0], 2.0, 1e-9);
  ASSERT_EQ(programme.entries(0).size(), 2U);
  programme.entries(0)[1] = 2.0;  // 2 x + y at most 6
  ASSERT_EQ(programme.primal(), LinearAnswer::kOptimal);
  EXPECT_NEAR(programme.solution()[0], 3.0, 1e-9);
}

TEST(LinearProgramme, ZerosAreNoEntries) {
  LinearColumns columns;
  columns.put(0, 0.0);
  columns.put(1, 1.0);
  columns.end(0.0, 1.0);
  LinearProgramme programme(LinearProgramme::Perturbation::kAutomatic);
  programme.load(columns, {-1.0, -1.0}, {1.0, 1.0});
  EXPECT_EQ(programme.entries(0).size(), 1U);
}

TEST(LinearProgramme, SaysWhereNothingIsWithinTheBoundsOrNothingIsLeast) {
  LinearColumns columns;
  columns.put(0, 1.0);
  columns.end(0.0, kNoBound, -1.0);
  LinearProgramme programme(LinearProgramme::Perturbation::kNone);
  programme.load(columns, {-kNoBound}, {-1.0});
  EXPECT_EQ(programme.dual(), LinearAnswer::kInfeasible);
  programme.load(columns, {1.0}, {kNoBound});
  EXPECT_EQ(programme.primal(), LinearAnswer::kUnsolved);
}

}  // namespace
}  // namespace locograph::linear_programme_test
