#include "pose_graph_run.h"

#include <locograph/common/deadline.h>
#include <locograph/core/graph_file.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/standard_types.h>

#include <algorithm>
#include <memory>

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
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");
  ThreadPool pool(threads);

  const Stopwatch watch;
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.use_threads(&pool);
  workspace.load_state();
  solver->use_threads(&pool);
  Optimiser optimiser(options);
  const double compiled = watch.seconds();
  optimiser.start(workspace, *solver);
  history.emplace_back(watch.seconds(), optimiser.result().initial.chi2);
  while (optimiser.iterate()) {
    history.emplace_back(watch.seconds(), optimiser.result().final.chi2);
  }
  workspace.store_state();
  history.emplace_back(watch.seconds(), optimiser.result().final.chi2);

  PoseGraphRun run = finished_run(history);
  run.build_s = compiled;
  run.iterations = optimiser.result().iterations;
  run.reason = optimiser.result().reason_text();
  run.ended = optimiser.result().reason != OptimiserResult::Reason::kMaxIterations &&
              optimiser.result().reason != OptimiserResult::Reason::kDeadline;
  run.state = workspace.state();
  run.linear_solver = solver->name();
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
