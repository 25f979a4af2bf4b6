#pragma once
/// One optimisation of a pose graph, by locograph or by a peer, and how its cost fell.
///
///     PoseGraphRun run = run_locograph(start, optimiser_options, 1);
///     std::cout << run.chi2 << " after " << run.total_s << " s\n";

#include <locograph/core/graph.h>
#include <locograph/core/optimiser.h>

#include <string>
#include <utility>
#include <vector>

namespace locograph {

struct PoseGraphRun {
  double chi2 = 0.0;
  double build_s = 0.0;  ///< of it (locograph), or before it (Ceres)
  double total_s = 0.0;
  double near_s = 0.0;  ///< to within 0.1 % of chi2
  int iterations = 0;   ///< steps taken
  bool ended = true;    ///< by itself, not by a limit
  std::string reason;
  std::string linear_solver;
  std::vector<double> state;
};

/// From pairs of (seconds, cost): the last one is the result.
PoseGraphRun finished_run(const std::vector<std::pair<double, double>>& history);

/// Compiling and analysis included. The graph is left as it is.
PoseGraphRun run_locograph(const Graph& start, const OptimiserOptions& options, int threads);

double median(const std::vector<PoseGraphRun>& runs, double PoseGraphRun::*value);

Graph copy_of(const Graph& graph);

}  // namespace locograph
