#pragma once
/// A graph solved by Ceres instead of by us: the cross-check of every type.
///
///     OptimiserResult result = optimise_with_ceres(graph, options);    // target locograph::ceres
///
/// Every edge becomes a ceres::CostFunction with our error and our derivative, weighted by a square
/// root of Ω; kernels become loss functions; every vertex a parameter block with our ⊞. No ambient
/// derivative is needed for that: a block's plus-Jacobian is said to be [I; 0], and the edges'
/// Jacobians [J 0], so that their product is the tangent derivative J.
///
/// What differs from Optimiser: the linear algebra (sparse Cholesky, or sparse Schur when vertices
/// are marked for elimination), the trust-region rules, and the meaning of λ, which is one over
/// Ceres's trust-region radius. Only there when CMake found Ceres; core does not depend on it.

#include <locograph/core/optimiser.h>

#include <vector>

namespace locograph {

/// Optimises all vertices that are not fixed and writes the result back to the graph. Levenberg-
/// Marquardt and dogleg; throws Error for Gauss-Newton and for edges marked as constraints.
OptimiserResult optimise_with_ceres(Graph& graph, const OptimiserOptions& options, int threads = 1);

/// What Ceres computes of a graph as it stands.
struct CeresEvaluation {
  double cost = 0.0;             ///< Σ ρ(eᵀΩe)
  std::vector<double> gradient;  ///< JᵀΩe by vertex, as Workspace::gradient()
};
CeresEvaluation evaluate_with_ceres(Graph& graph);

}  // namespace locograph
