// Programmes whose corners are known by hand, and random ones whose optimum Clp finds, which shares
// nothing with it.
#include <gtest/gtest.h>
#include <locograph/planners/balance/linear_programme.h>

#include <ClpSimplex.hpp>
#include <cmath>
#include <random>
#include <vector>

namespace locograph::linear_programme_test {
namespace {

/// x and y from 0 on with x + 2 y at most 4 and 3 x + y at most 6; its corner is (1.6, 1.2).
LinearProgramme two_limits() {
  LinearProgramme programme;
  programme.resize(2, 2);
  programme.matrix() << 1.0, 2.0, 3.0, 1.0;
  programme.cost() << -1.0, -1.0;
  programme.bound_row(0, -kNoBound, 4.0);
  programme.bound_row(1, -kNoBound, 6.0);
  return programme;
}

TEST(LinearProgramme, FindsTheCornerOfLeastCostAndWhatItsBoundsAreWorth) {
  LinearProgramme programme = two_limits();
  ASSERT_EQ(programme.solve(), LinearAnswer::kOptimal);
  EXPECT_TRUE(programme.solution().isApprox(Eigen::Vector2d(1.6, 1.2), 1e-12));
  EXPECT_TRUE(programme.prices().isApprox(Eigen::Vector2d(-0.4, -0.2), 1e-12));
  EXPECT_NEAR(programme.value(), -2.8, 1e-12);
}

TEST(LinearProgramme, GoesOnFromTheLastCornerWithOtherCostsBoundsAndEntries) {
  LinearProgramme programme = two_limits();
  ASSERT_EQ(programme.solve(), LinearAnswer::kOptimal);
  programme.cost()[1] = 1.0;
  ASSERT_EQ(programme.solve(), LinearAnswer::kOptimal);
  EXPECT_NEAR(programme.solution()[0], 2.0, 1e-12);
  programme.matrix()(1, 0) = 2.0;  // 2 x + y at most 6
  ASSERT_EQ(programme.solve(), LinearAnswer::kOptimal);
  EXPECT_NEAR(programme.solution()[0], 3.0, 1e-12);
  programme.bound_column(0, 0.0, 2.5);
  ASSERT_EQ(programme.solve(), LinearAnswer::kOptimal);
  EXPECT_NEAR(programme.solution()[0], 2.5, 1e-12);
}

TEST(LinearProgramme, SaysWhereNothingIsWithinTheBoundsOrNothingIsLeast) {
  LinearProgramme programme;
  programme.resize(1, 1);
  programme.matrix()(0, 0) = 1.0;
  programme.cost()[0] = -1.0;
  programme.bound_row(0, -kNoBound, -1.0);
  EXPECT_EQ(programme.solve(), LinearAnswer::kInfeasible);
  programme.bound_row(0, 1.0, kNoBound);
  EXPECT_EQ(programme.solve(), LinearAnswer::kUnsolved);
  programme.bound_row(0, 1.0, 3.0);
  EXPECT_EQ(programme.solve(), LinearAnswer::kOptimal);
}

TEST(LinearProgramme, HasNoOptimumWhereNumbersAreNoneOrBoundsAreTheWrongWayRound) {
  LinearProgramme programme = two_limits();
  programme.matrix()(1, 1) = std::nan("");
  EXPECT_NE(programme.solve(), LinearAnswer::kOptimal);
  programme = two_limits();
  programme.bound_row(0, std::nan(""), 4.0);
  EXPECT_NE(programme.solve(), LinearAnswer::kOptimal);
  programme = two_limits();
  programme.bound_column(0, 3.0, 2.0);
  EXPECT_NE(programme.solve(), LinearAnswer::kOptimal);
  programme = two_limits();
  programme.bound_row(1, 7.0, 6.0);
  EXPECT_NE(programme.solve(), LinearAnswer::kOptimal);
}

TEST(LinearProgramme, WithoutRowsEachColumnIsAtItsBetterBound) {
  LinearProgramme programme;
  programme.resize(0, 2);
  programme.cost() << 1.0, -1.0;
  programme.bound_column(0, -2.0, 3.0);
  programme.bound_column(1, -2.0, 3.0);
  ASSERT_EQ(programme.solve(), LinearAnswer::kOptimal);
  EXPECT_EQ(programme.solution(), Eigen::Vector2d(-2.0, 3.0));
}

/// Of the shape of those about contacts: equalities, rows with one bound and with two, columns from
/// 0 up, within two bounds and without any; many entries 0 and many equal, so that corners are
/// degenerate. Feasible about a known point, or not.
struct RandomProgramme {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd cost, least, most, lower, upper;

  explicit RandomProgramme(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto one_of = [&](unsigned count) { return static_cast<unsigned>(random()) % count; };
    const int rows = 4 + static_cast<int>(one_of(60)), columns = 4 + static_cast<int>(one_of(60));
    const bool round = one_of(2) == 0;
    matrix = Eigen::MatrixXd::NullaryExpr(rows, columns, [&] {
      if (one_of(3) == 0) return 0.0;
      return round ? static_cast<double>(one_of(3)) - 1.0 : unit(random);
    });
    cost.resize(columns);
    least.resize(columns);
    most.resize(columns);
    Eigen::VectorXd inside(columns);
    for (int c = 0; c < columns; ++c) {
      const unsigned kind = one_of(8);
      cost[c] = one_of(2) == 0 ? 0.0 : std::abs(unit(random));
      least[c] = kind == 0 ? -kNoBound : kind < 3 ? -1.0 : 0.0;
      most[c] = kind == 0 ? kNoBound : kind < 4 ? 1.0 : kNoBound;
      if (kind == 0) cost[c] = 0.0;
      if (kind == 2) cost[c] = -cost[c];
      inside[c] = one_of(2) == 0 ? 0.0 : std::abs(unit(random));
    }
    const Eigen::VectorXd at = matrix * inside;
    lower.resize(rows);
    upper.resize(rows);
    for (int r = 0; r < rows; ++r) {
      const unsigned kind = one_of(6);
      const double room = one_of(3) == 0 ? 0.0 : std::abs(unit(random));
      lower[r] = kind == 1 ? -kNoBound : kind == 0 ? at[r] : at[r] - room;
      upper[r] = kind == 2 ? kNoBound : kind == 0 ? at[r] : at[r] + room;
    }
    if (one_of(5) == 0) lower[0] = upper[0] = at[0] + 20.0 * unit(random);
  }

  void give(LinearProgramme& programme) const {
    programme.resize(static_cast<int>(lower.size()), static_cast<int>(cost.size()));
    programme.matrix() = matrix;
    programme.cost() = cost;
    for (int c = 0; c < cost.size(); ++c) programme.bound_column(c, least[c], most[c]);
    for (int r = 0; r < lower.size(); ++r) programme.bound_row(r, lower[r], upper[r]);
  }

  /// By Clp; infinity: infeasible; nothing known: NaN.
  double optimum() const {
    CoinPackedMatrix packed(true, 0, 0);
    packed.setDimensions(static_cast<int>(lower.size()), 0);
    std::vector<int> all(static_cast<std::size_t>(lower.size()));
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    for (int c = 0; c < cost.size(); ++c) {
      packed.appendCol(static_cast<int>(all.size()), all.data(), matrix.col(c).data());
    }
    ClpSimplex simplex;
    simplex.setLogLevel(0);
    simplex.setPrimalTolerance(1e-9);
    simplex.setDualTolerance(1e-9);
    simplex.loadProblem(packed, least.data(), most.data(), cost.data(), lower.data(), upper.data());
    simplex.dual();
    if (simplex.isProvenOptimal()) return simplex.objectiveValue();
    return simplex.isProvenPrimalInfeasible() ? kNoBound : std::nan("");
  }
};

TEST(LinearProgramme, FindsTheOptimumThatClpFinds) {
  int optimal = 0, infeasible = 0;
  for (unsigned seed = 1; seed <= 600; ++seed) {
    const RandomProgramme random(seed);
    LinearProgramme programme;
    random.give(programme);
    const LinearAnswer answer = programme.solve();
    const double optimum = random.optimum();
    if (std::isnan(optimum)) continue;
    if (std::isinf(optimum)) {
      EXPECT_EQ(answer, LinearAnswer::kInfeasible) << seed;
      ++infeasible;
      continue;
    }
    ASSERT_EQ(answer, LinearAnswer::kOptimal) << seed;
    EXPECT_NEAR(programme.value(), optimum, 1e-7 * (1.0 + std::abs(optimum))) << seed;
    ++optimal;
  }
  EXPECT_GT(optimal, 300);
  EXPECT_GT(infeasible, 30);
}

/// As while a robot moves: each programme is a little other than the one before.
TEST(LinearProgramme, FollowsAProgrammeThatChanges) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0.0, 1e-2);
  int optimal = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    RandomProgramme changing(seed);
    LinearProgramme programme;
    for (int step = 0; step < 10; ++step) {
      changing.matrix += Eigen::MatrixXd::NullaryExpr(
          changing.matrix.rows(), changing.matrix.cols(), [&] { return normal(random); });
      changing.give(programme);
      const LinearAnswer answer = programme.solve();
      const double optimum = changing.optimum();
      if (!std::isfinite(optimum)) continue;
      ASSERT_EQ(answer, LinearAnswer::kOptimal) << seed << ", " << step;
      EXPECT_NEAR(programme.value(), optimum, 1e-7 * (1.0 + std::abs(optimum)))
          << seed << ", " << step;
      ++optimal;
    }
  }
  EXPECT_GT(optimal, 50);
}

}  // namespace
}  // namespace locograph::linear_programme_test
