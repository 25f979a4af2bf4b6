#include "pose_graph_run.h"

#include <locograph/core/graph_file.h>
#include <locograph/types/standard_types.h>

#include <algorithm>

#include "started_run.h"

namespace locograph {

PoseGraphRun finished_run(const std::vector<std::pair<double, double>>& history) {
  PoseGraphRun run;
  run.total_s = history.back().first;
  run.chi2 = history.back().second;
  run.near_s = std::find_if(history.begin(), history.end(), [&](const auto& point) {
                 return point.second <= 1.001 * run.chi2;
               })->first;
  return run;
}

PoseGraphRun run_locograph(const Graph& start, const OptimiserOptions& options, int threads) {
  Graph graph = copy_of(start);
  std::vector<std::pair<double, double>> history;
  history.reserve(options.max_iterations + 2);
  StartedRun started(graph, options, "auto", threads);
  const OptimiserResult& result = started.optimiser.result();
  history.emplace_back(started.started_s, result.initial.chi2);
  while (started.optimiser.iterate()) {
    history.emplace_back(started.watch.seconds(), result.final.chi2);
  }
  started.workspace.store_state();
  history.emplace_back(started.watch.seconds(), result.final.chi2);

  PoseGraphRun run = finished_run(history);
  run.build_s = started.loaded_s;
  run.iterations = result.iterations;
  run.reason = result.reason_text();
  run.ended = result.reason != OptimiserResult::Reason::kMaxIterations &&
              result.reason != OptimiserResult::Reason::kDeadline;
  run.state = started.workspace.state();
  run.linear_solver = started.solver->name();
  return run;
}

double median(const std::vector<PoseGraphRun>& runs, double PoseGraphRun::*value) {
  std::vector<double> values;
  for (const PoseGraphRun& run : runs) values.push_back(run.*value);
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Graph copy_of(const Graph& graph) {
  return read_graph_text(write_graph_text(graph), "copy", ".", standard_types());
}

}  // namespace locograph
