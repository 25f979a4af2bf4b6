#pragma once
/// First values of all poses at once, from the measurements between them: chordal relaxation.
///
///     int unreached = guess_chordal(graph, *make_linear_solver("auto"));
///
/// Unlike a walk along a spanning tree this spreads the noise over all loops, so that local minima
/// are rare afterwards (Martinec & Pajdla 2007; Carlone et al. 2015, "Initialization techniques for
/// 3D SLAM"). Two sparse linear solves on the pattern of the pose graph:
///
///  1. rotations: min Σ w ‖R_b − R_a Z‖²_F over matrices, each then projected to SO(n) by its
///     singular value decomposition; w is the mean of the diagonal of Ω's rotational block;
///  2. translations given those rotations: min Σ rᵀΩr with Ω's translational block.
///
/// Used are the relative poses (EDGE_SE2, EDGE_SE3:QUAT and both _OFFSET forms) and the priors of
/// poses. Fixed vertices keep their state. A part that neither a fixed vertex nor a prior of the
/// whole pose holds keeps the state of its first vertex; if it has enough priors of a position, it
/// is then moved onto them as a whole. Points and what else is left follow by prediction, as in
/// guess_from_spanning_tree(). Robust kernels are not looked at: where loop closures may be wrong,
/// leave out those that doubtful_closures() finds.

#include <locograph/core/graph.h>
#include <locograph/core/linear_solver.h>

#include <span>

namespace locograph {

/// Returns the number of vertices that nothing reaches: they keep their state. When a linear system
/// cannot be solved (information beyond the range of numbers) every value comes from the spanning
/// tree instead. Leaves `solver` analysed for the pose graph. `left_out`: slots of edges not to
/// use.
int guess_chordal(Graph& graph, LinearSolver& solver, std::span<const int> left_out = {});

}  // namespace locograph
