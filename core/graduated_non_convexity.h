#pragma once
/// Graduated non-convexity: optimises although many measurements are plainly wrong.
///
///     GraduationOptions options;
///     GraduationResult result = optimise_graduated(graph, options, *solver, trusted_edges);
///     if (result.weight[e.slot] < 0.5) std::cerr << "that measurement is wrong\n";
///
/// Yang, Antonante, Tzoumas & Carlone 2020 ("Graduated non-convexity for robust spatial
/// perception"): an outer loop over the optimiser on one compiled problem. Every suspect edge gets
/// a robust kernel that begins nearly convex and is sharpened in rounds, a few iterations each,
/// until it is truncated least squares (their GNC-TLS) or Geman-McClure (GNC-GM). The inner weights
/// are those of the kernel at the current error, so no separate weight update is needed (Black &
/// Rangarajan 1996). An edge's own kernel is set aside meanwhile and put back at the end.
///
/// An edge counts as an inlier while s = eᵀΩe stays below c², the quantile of the χ² distribution
/// with as many degrees of freedom as the edge has dimensions: Ω must be what it claims to be, the
/// inverse of the covariance. Where it is not, set `width`.
///
/// Edges known to be right (odometry, priors) should be named as trusted; they keep their kernel.
/// Constraints are never suspect.
/// Start from values that do not rest on wrong edges: odometry, or where that drifts too far the
/// chordal guess without the doubtful closures (types/doubtful_closures.h), naming these as
/// doubted. Doubted edges are left out of the problem, so that they neither pull nor fill its
/// matrix, until their s is below c² at the optimum of the others. Deterministic.

#include <locograph/core/optimiser.h>

#include <span>
#include <vector>

namespace locograph {

enum class Graduation { kTruncated, kGemanMcClure };

struct GraduationOptions {
  Graduation kind = Graduation::kTruncated;
  /// Probability that s of a right measurement is below c².
  double inlier_probability = 0.99;
  /// inlier_probability is that of all right measurements together: each of m suspect edges gets
  /// the quantile at 1 − (1 − p)/m (Bonferroni), lest a graph loses one in a hundred of them. For
  /// good initial values; from poor ones the narrower c rejects more of what is wrong.
  bool for_all = false;
  /// c for every suspect edge; 0: from inlier_probability and the dimension of the edge.
  double width = 0.0;
  /// By which the control parameter μ changes from round to round.
  double factor = 1.4;
  int max_rounds = 100;
  /// Most iterations of each round but the last, which goes on to convergence.
  int iterations_per_round = 3;
  OptimiserOptions optimiser;

  /// Throws Error naming the option that is out of range.
  void validate() const;
};

struct GraduationResult {
  OptimiserResult optimiser;  ///< of the last round; `initial` is that of the first
  int rounds = 0;
  int iterations = 0;          ///< of all rounds
  std::vector<double> weight;  ///< by edge slot, in [0, 1]; 1 for edges that are not suspect
  int rejected = 0;            ///< suspect edges whose weight is below ½
};

/// The problem must be compiled and the workspace hold the initial state, as for an Optimiser.
/// `trusted` are edge slots.
GraduationResult optimise_graduated(Workspace& workspace, const GraduationOptions& options,
                                    LinearSolver& solver, std::span<const int> trusted = {});
/// Compiles, optimises and writes the result back to the graph. Leaving out the `doubted` edges
/// must not disconnect it. Doubted edges that stay out count as rejected, but not in the costs.
GraduationResult optimise_graduated(Graph& graph, const GraduationOptions& options,
                                    LinearSolver& solver, std::span<const int> trusted = {},
                                    std::span<const int> doubted = {},
                                    ThreadPool* threads = nullptr);

/// Slots of the edges that are no loop closures: on one vertex, on consecutive ids, or on a vertex
/// that nothing else measures.
std::vector<int> odometry_edges(const Graph& graph);

/// x with P(X ≤ x) = probability for χ² with `freedom` ≥ 1 degrees of freedom.
double chi_squared_quantile(int freedom, double probability);

}  // namespace locograph
