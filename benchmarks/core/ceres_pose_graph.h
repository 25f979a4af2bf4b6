#pragma once
/// A pose graph solved by Ceres: the same problem that locograph solves.
///
///     PoseGraphRun run = run_ceres(start, {.nonmonotonic = true});
///
/// A residual is locograph's own error() evaluated on ceres::Jet, times a square root of Ω. The
/// time is what ceres::Solve takes, its preprocessing included; building the ceres::Problem is
/// `build_s`.

#include "pose_graph_run.h"

namespace locograph {

struct CeresOptions {
  bool nonmonotonic = false;
  int max_iterations = 300;
  double max_seconds = 1e6;
};

/// SPARSE_NORMAL_CHOLESKY with SuiteSparse, one thread, function tolerance 1e-7, else its defaults.
/// Of EDGE_SE2 or EDGE_SE3:QUAT alone; vertex 0 is held. The graph is left as it is.
PoseGraphRun run_ceres(const Graph& start, const CeresOptions& options = {});

}  // namespace locograph
