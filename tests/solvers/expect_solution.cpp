#include "solvers/expect_solution.h"

#include <gtest/gtest.h>

#include <limits>

namespace locograph::test {

void expect_solution(const LinearSolver& solver, const RandomSystem& system, double tolerance) {
  Eigen::VectorXd x(system.pattern.scalar_size());
  solver.solve(system.right_hand_side.data(), x.data());
  const Eigen::VectorXd& expected = system.expected();
  EXPECT_LE((x - expected).norm(), tolerance * expected.norm()) << solver.name();
  // The right-hand side may be overwritten by the solution: the same bits.
  Eigen::VectorXd in_place =
      Eigen::Map<const Eigen::VectorXd>(system.right_hand_side.data(), x.size());
  solver.solve(in_place.data(), in_place.data());
  EXPECT_EQ(in_place, x);
}

void expect_bad_blocks_named(LinearSolver& solver, const RandomSystem& good, double tolerance) {
  for (int bad = 0; bad < good.pattern.size(); bad += 1 + good.pattern.size() / 5) {
    for (const double value : {-1e6, std::numeric_limits<double>::quiet_NaN()}) {
      // All other blocks together are positive definite, so whatever the order, this one fails.
      RandomSystem a = good;
      const int last = a.pattern.dimension[bad] - 1;
      a.for_each_block([&](int r, int c, auto block) {
        if (r == bad && c == bad) block(last, last) = value;
      });
      EXPECT_FALSE(solver.factorise(a.values.data(), a.damping.data()));
      EXPECT_EQ(solver.failed_row(), bad) << solver.name() << " with " << value;
    }
  }
  ASSERT_TRUE(solver.factorise(good.values.data(), good.damping.data()));
  EXPECT_EQ(solver.failed_row(), -1);
  expect_solution(solver, good, tolerance);
}

}  // namespace locograph::test
