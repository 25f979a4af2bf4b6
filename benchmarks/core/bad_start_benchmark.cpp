/// Pose graphs from poor start values: locograph as `optimize` runs it against Ceres, once as it is
/// and once with non-monotonic steps, from the same start.
///
///     bad_start_benchmark [--starts file,odometry,perturbed:1,perturbed:2,best] [FILE.g2o…]
///
/// Prints one JSON object; times in seconds, of the whole solve, on one thread, median of the runs.
/// `ended` is false where a limit of iterations or seconds ended the solver. `file` are
/// the file's values, `perturbed:SEED` these moved by metres and radians (perturbed_start.h),
/// `best` what take_best_guess() takes; all else is as in pose_graph_benchmark.

#include <locograph/core/graph_file.h>
#include <locograph/core/initial_guess.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/best_guess.h>
#include <locograph/types/standard_types.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "ceres_pose_graph.h"
#include "command_line.h"
#include "perturbed_start.h"
#include "pose_graph_files.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

struct BadStartOptions {
  int runs = 1;
  int max_iterations = 300;
  double max_seconds = 60.0;
  bool without_ceres = false;
  std::vector<std::string> starts = {"file", "odometry", "perturbed:1", "perturbed:2", "best"};
  std::vector<std::filesystem::path> files = pose_graph_files();
};

Graph start_of(const std::filesystem::path& file, const std::string& start) {
  Graph graph = read_graph(file, standard_types(), {.lenient = true});
  graph.set_fixed(0, true);
  const std::string perturbed = "perturbed:";
  if (start == "odometry") {
    guess_from_odometry(graph);
  } else if (start.starts_with(perturbed)) {
    perturb(graph, static_cast<unsigned>(std::stoul(start.substr(perturbed.size()))));
  } else if (start == "best") {
    Problem problem;
    problem.compile(graph);
    Workspace workspace;
    workspace.allocate(problem);
    take_best_guess(workspace, *make_linear_solver("auto"));
  } else if (start != "file") {
    throw Error("unknown start " + start, "file, odometry, perturbed:SEED or best");
  }
  return graph;
}

Json report(const std::vector<PoseGraphRun>& runs) {
  return {{"chi2", runs[0].chi2},
          {"iterations", runs[0].iterations},
          {"ended", runs[0].ended},
          {"reason", runs[0].reason},
          {"total", median(runs, &PoseGraphRun::total_s)}};
}

Json compare(const std::filesystem::path& file, const std::string& start_name,
             const BadStartOptions& options) {
  const Graph start = start_of(file, start_name);
  std::vector<PoseGraphRun> ours, ceres, nonmonotonic;
  for (int i = 0; i < options.runs; ++i) {
    OptimiserOptions optimiser = OptimiserOptions::for_any_start();
    optimiser.gain = 1e-7;
    optimiser.max_iterations = options.max_iterations;
    optimiser.deadline = Deadline::after(options.max_seconds);
    ours.push_back(run_locograph(start, optimiser, 1));
    if (options.without_ceres) continue;
    ceres.push_back(run_ceres(start, {false, options.max_iterations, options.max_seconds}));
    nonmonotonic.push_back(run_ceres(start, {true, options.max_iterations, options.max_seconds}));
  }
  Json json = {{"file", file.filename().string()}, {"start", start_name}};
  json["locograph"] = report(ours);
  if (!options.without_ceres) {
    json["ceres"] = report(ceres);
    json["ceres_nonmonotonic"] = report(nonmonotonic);
  }
  return json;
}

void run(const BadStartOptions& options) {
  if (options.files.empty()) throw Error("no graph files", "FILE.g2o arguments");
  Json all = {{"unit", "s"},
              {"runs", options.runs},
              {"max_iterations", options.max_iterations},
              {"max_seconds", options.max_seconds},
              {"graphs", Json::array()}};
  for (const std::filesystem::path& file : options.files) {
    for (const std::string& start : options.starts) {
      all["graphs"].push_back(compare(file, start, options));
      std::cerr << all["graphs"].back().dump() << "\n";
    }
  }
  std::cout << all.dump(1) << "\n";
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  using namespace locograph;
  BadStartOptions options;
  OptionParser app("Pose graphs from poor start values", "bad_start_benchmark");
  app.add_option("FILE", options.files, "Pose graphs (.g2o); default: the shared data");
  app.add_option("--starts", options.starts, "file, odometry, perturbed:SEED or best")
      .separated_by(',');
  app.add_option("--runs", options.runs, "Measurements of each").positive();
  app.add_option("--iterations", options.max_iterations, "Most iterations of each").positive();
  app.add_option("--seconds", options.max_seconds, "Most seconds of each").positive();
  app.add_flag("--without-ceres", options.without_ceres, "Measure locograph alone");
  return run_benchmark(app, argc, argv, [&] { run(options); });
}
