#pragma once
/// What every linear solver is held to: the dense solution, and the name of the block at fault.
///
///     solver.analyse(system.pattern);
///     ASSERT_TRUE(solver.factorise(system.values.data(), system.damping.data()));
///     expect_solution(solver, system, 1e-12);

#include <gtest/gtest.h>
#include <locograph/core/linear_solver.h>

#include <limits>

#include "solvers/random_system.h"

namespace locograph::test {

/// solver: factorised. tolerance: relative, of the whole solution.
inline void expect_solution(const LinearSolver& solver, const RandomSystem& system,
                            double tolerance) {
  Eigen::VectorXd x(system.pattern.scalar_size());
  solver.solve(system.right_hand_side.data(), x.data());
  const Eigen::VectorXd expected = system.expected();
  EXPECT_LE((x - expected).norm(), tolerance * expected.norm()) << solver.name();
  // The right-hand side may be overwritten by the solution: the same bits.
  Eigen::VectorXd in_place =
      Eigen::Map<const Eigen::VectorXd>(system.right_hand_side.data(), x.size());
  solver.solve(in_place.data(), in_place.data());
  EXPECT_EQ(in_place, x);
}

/// solver: analysed. One diagonal block after another is spoilt, which the solver has to name, and
/// then solves the good system.
inline void expect_bad_blocks_named(LinearSolver& solver, const RandomSystem& good,
                                    double tolerance) {
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
