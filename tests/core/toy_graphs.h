#pragma once
/// Graphs to optimise in tests, and the algorithms to optimise them with.

#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/slam3d/edges.h>

#include "core/toy_types.h"

namespace locograph::test {

inline constexpr Algorithm kAlgorithms[] = {Algorithm::kGaussNewton, Algorithm::kLevenbergMarquardt,
                                            Algorithm::kDogleg};
std::string name_of(Algorithm algorithm);

/// A ring of noisy planar poses with a chord, the first one fixed.
Graph ring_2d(int size, double noise = 0.05);

/// The same in space: a helix of poses with ties between its turns.
Graph helix_3d(int size, double noise = 0.05);

/// Points tied by edges of run-time arity, and arms that reach for them.
template <Derivatives D>
Graph mixed_graph();

/// Posture, reach and a signal: sizes known at run time, derived quantities by hand.
Graph sized_graph();

OptimiserResult run(Graph& graph, const OptimiserOptions& options,
                    const std::string& solver = "auto");

}  // namespace locograph::test
