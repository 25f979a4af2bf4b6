#pragma once
/// A graph that is compiled, and an optimiser that has started on it.
///
///     StartedRun run(graph, options, "auto", 1);
///     while (run.optimiser.iterate()) {
///     }
///     std::cout << run.watch.seconds() << " s\n";

#include <locograph/common/deadline.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>

#include <memory>
#include <string>

namespace locograph {

struct StartedRun {
  /// Throws Error for an unknown solver. The graph must outlive the run.
  StartedRun(Graph& graph, const OptimiserOptions& options, const std::string& solver_name,
             int threads)
      : pool(threads), solver(make_linear_solver(solver_name)), optimiser(options) {
    watch = Stopwatch();
    problem.compile(graph);
    compiled_s = watch.seconds();
    workspace.allocate(problem);
    workspace.use_threads(&pool);
    workspace.load_state();
    solver->use_threads(&pool);
    loaded_s = watch.seconds();
    optimiser.start(workspace, *solver);
    started_s = watch.seconds();
  }

  ThreadPool pool;
  std::unique_ptr<LinearSolver> solver;
  Problem problem;
  Workspace workspace;
  Optimiser optimiser;
  Stopwatch watch;  ///< since before the graph was compiled
  double compiled_s = 0.0, loaded_s = 0.0, started_s = 0.0;  ///< by the watch
};

}  // namespace locograph
