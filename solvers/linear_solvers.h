#pragma once
/// The linear solvers there are, by name.
///
///     std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");
///
/// dense           Cholesky of the whole matrix: a few dozen scalar rows
/// banded          block band, natural order: trajectories, moving horizons
/// block-cholesky  block-sparse, supernodal, for everything else: pose graphs
/// schur           vertices marked for elimination first; schur-dense, schur-sparse and schur-pcg
///                 name the solver of what is left, schur chooses it
/// pcg             conjugate gradients, block-Jacobi preconditioner: what no factor fits
/// auto            the cheapest of the direct ones by estimated cost, decided in analyse()
/// eigen           Eigen::SimplicialLLT, to compare with
/// cholmod         CHOLMOD, if it was there when this was built; GPL, never chosen by auto

#include <locograph/core/linear_solver.h>

#include <memory>
#include <string>
#include <vector>

namespace locograph {

/// Throws Error naming the solvers there are.
std::unique_ptr<LinearSolver> make_linear_solver(const std::string& name);
std::vector<std::string> linear_solver_names();

}  // namespace locograph
