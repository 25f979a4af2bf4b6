#pragma once
/// What every linear solver is held to: the dense solution, and the name of the block at fault.
///
///     solver.analyse(system.pattern);
///     ASSERT_TRUE(solver.factorise(system.values.data(), system.damping.data()));
///     expect_solution(solver, system, 1e-12);

#include <locograph/core/linear_solver.h>

#include "solvers/random_system.h"

namespace locograph::test {

/// solver: factorised. tolerance: relative, of the whole solution.
void expect_solution(const LinearSolver& solver, const RandomSystem& system, double tolerance);

/// solver: analysed. One diagonal block after another is spoilt, which the solver has to name, and
/// then solves the good system.
void expect_bad_blocks_named(LinearSolver& solver, const RandomSystem& good, double tolerance);

}  // namespace locograph::test
