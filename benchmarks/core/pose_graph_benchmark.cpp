/// Pose graphs to convergence: locograph (Levenberg-Marquardt, default options) against Ceres on
/// the same problem, from the same initial values, in the same run, one thread each.
///
///     pose_graph_benchmark [--runs N] [FILE.g2o…]      # default: all public files of shared data
///     pose_graph_benchmark --g2o PROGRAM --gtsam PROGRAM   # these as well (see peer_program.h)
///     pose_graph_benchmark --guess chordal …           # everybody starts from a better guess
///
/// Prints one JSON object. Times in seconds, median of the runs; `time_to_0.1%` is from the loaded
/// graph to the first accepted step whose cost is within 0.1 % of the value that optimiser
/// converges to. For locograph this includes compiling the problem; for Ceres it is what
/// Solver::Solve takes, its preprocessing included, building the ceres::Problem not (reported as
/// `build`). Peers read the same initial values from a file. locograph and Ceres see the same
/// error: the residual of Ceres is locograph's own error() evaluated on ceres::Jet, times a square
/// root of Ω.

#include <locograph/core/graph_file.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/chordal_guess.h>
#include <locograph/types/standard_types.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "ceres_pose_graph.h"
#include "command_line.h"
#include "peer_program.h"
#include "pose_graph_files.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

/// The graph that everybody starts from.
Graph start_of(const std::filesystem::path& file, bool chordal) {
  Graph graph = read_graph(file, standard_types(), {.lenient = true});
  graph.set_fixed(0, true);
  if (chordal) guess_chordal(graph, *make_linear_solver("auto"));
  return graph;
}

Json report(const std::vector<PoseGraphRun>& runs) {
  Json json;
  json["chi2"] = runs[0].chi2;
  if (runs[0].iterations > 0) json["iterations"] = runs[0].iterations;
  if (!runs[0].reason.empty()) json["reason"] = runs[0].reason;
  json["time_to_0.1%"] = median(runs, &PoseGraphRun::near_s);
  json["total"] = median(runs, &PoseGraphRun::total_s);
  return json;
}

struct Options {
  int runs = 3;
  bool chordal = false;
  std::vector<PeerProgram> peers;
  std::vector<std::filesystem::path> files = pose_graph_files();
};

/// How much longer each peer took: time to 0.1 %, by name.
using Ratios = std::map<std::string, std::vector<double>>;

Json compare(const std::filesystem::path& file, const Options& options, Ratios& ratios) {
  const Graph start = start_of(file, options.chordal);
  const std::filesystem::path copy = std::filesystem::temp_directory_path() /
                                     ("pose_graph_benchmark_" + std::to_string(getpid()) + ".g2o");
  if (!options.peers.empty()) write_graph(start, copy);
  std::vector<PoseGraphRun> one, two, ceres;
  std::vector<std::vector<PoseGraphRun>> peers(options.peers.size());
  OptimiserOptions optimiser;
  optimiser.gain = 1e-7;
  // Alternating, so that all see the same state of the machine.
  for (int i = 0; i < options.runs; ++i) {
    one.push_back(run_locograph(start, optimiser, 1));
    two.push_back(run_locograph(start, optimiser, 2));
    ceres.push_back(run_ceres(start));
    for (std::size_t p = 0; p < peers.size(); ++p) {
      auto history = run_peer(options.peers[p], copy);
      if (!history.empty()) peers[p].push_back(finished_run(history));
    }
  }
  std::filesystem::remove(copy);
  Json json;
  json["file"] = file.filename().string();
  json["locograph"] = report(one);
  json["locograph"]["linear_solver"] = one[0].linear_solver;
  json["locograph"]["compile"] = median(one, &PoseGraphRun::build_s);
  json["two_threads"] = {
      {"total", median(two, &PoseGraphRun::total_s)},
      {"speed_up", median(one, &PoseGraphRun::total_s) / median(two, &PoseGraphRun::total_s)},
      {"same_bits", one[0].state == two[0].state}};
  const double ours = median(one, &PoseGraphRun::near_s);
  const auto add = [&](const std::string& name, const std::vector<PoseGraphRun>& theirs) {
    if (theirs.empty()) {
      json[name] = nullptr;
      return;
    }
    json[name] = report(theirs);
    json[name]["ratio"] = median(theirs, &PoseGraphRun::near_s) / ours;
    ratios[name].push_back(median(theirs, &PoseGraphRun::near_s) / ours);
  };
  add("ceres", ceres);
  for (std::size_t p = 0; p < peers.size(); ++p) add(options.peers[p].name, peers[p]);
  const double a = one[0].chi2, b = ceres[0].chi2;
  json["same_optimum_as_ceres"] = std::abs(a - b) <= 1e-3 * std::min(a, b);
  return json;
}

void run(const Options& options) {
  if (options.files.empty()) throw Error("no graph files", "FILE.g2o arguments");
  Json all = {{"unit", "s"},
              {"runs", options.runs},
              {"guess", options.chordal ? "chordal" : "file"},
              {"graphs", Json::array()}};
  Ratios ratios;
  for (const std::filesystem::path& file : options.files) {
    std::cerr << file.filename().string() << "\n";
    all["graphs"].push_back(compare(file, options, ratios));
  }
  for (const auto& [name, values] : ratios) {
    double logarithms = 0.0;
    for (const double ratio : values) logarithms += std::log(ratio);
    all["times_faster_than"][name] = {{"files", values.size()},
                                      {"geometric_mean", std::exp(logarithms / values.size())},
                                      {"least", *std::min_element(values.begin(), values.end())}};
  }
  std::cout << all.dump(1) << "\n";
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  using namespace locograph;
  Options options;
  std::string guess, g2o, gtsam;
  OptionParser app("Pose graphs to convergence", "pose_graph_benchmark");
  app.add_option("FILE", options.files, "Pose graphs (.g2o); default: the shared data");
  app.add_option("--runs", options.runs, "Measurements of each").positive();
  app.add_option("--guess", guess, "What everybody starts from").one_of({"chordal"});
  app.add_option("--g2o", g2o, "Program to compare with");
  app.add_option("--gtsam", gtsam, "Program to compare with");
  return run_benchmark(app, argc, argv, [&] {
    options.chordal = guess == "chordal";
    if (!g2o.empty()) {
      for (const char* solver : {"lm_var_cholmod", "lm_var", "gn_var_cholmod"}) {
        options.peers.push_back({std::string("g2o ") + solver, g2o, solver});
      }
    }
    if (!gtsam.empty()) options.peers.push_back({"gtsam", gtsam, ""});
    run(options);
  });
}
