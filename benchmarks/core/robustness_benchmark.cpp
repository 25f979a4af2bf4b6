/// Pose graphs of which every tenth loop closure is false: what plain least squares, robust kernels
/// and graduated non-convexity make of them.
///
///     robustness_benchmark [--fraction F] [--seed N] [--method NAME]… [FILE.g2o…]
///
/// Prints one JSON object. For each method: chi2 of the true edges over that of the optimum without
/// false ones, root mean square and largest distance of the positions from that optimum [m], how
/// many false closures were kept and how many true ones rejected (weight below and above ½), and
/// the time [s]. `:closures` after a kernel: on loop closures only, otherwise on every edge.
/// `chordal+` before a method: from the chordal guess without the doubtful closures, and garbage
/// before it; otherwise from odometry.

#include <locograph/common/deadline.h>
#include <locograph/core/graduated_non_convexity.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/initial_guess.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/chordal_guess.h>
#include <locograph/types/doubtful_closures.h>
#include <locograph/types/standard_types.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "command_line.h"
#include "false_loop_closures.h"
#include "pose_graph_files.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

Graph load(const std::filesystem::path& file) {
  Graph graph = read_graph(file, standard_types(), {.lenient = true});
  graph.set_fixed(0, true);
  return graph;
}

double chi2(Graph& graph) {
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  return workspace.evaluate(workspace.state()).chi2;
}

template <class E>
class Case {
 public:
  Case(const std::filesystem::path& file, double fraction, unsigned seed)
      : file_(file), optimum_(load(file)) {
    const std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");
    guess_chordal(optimum_, *solver);
    best_ = optimise(optimum_, {}, *solver).final.chi2;
    wrong_ = make_false_closures<E>(optimum_, fraction, seed);
  }

  Json run(const std::vector<std::string>& methods) const {
    Json json;
    json["file"] = file_.filename().string();
    json["false_closures"] = wrong_.edges.size();
    json["chi2_without_them"] = best_;
    for (const std::string& method : methods) {
      json[method] = run(method);
      std::cerr << "  " << method << ": " << json[method].dump() << "\n";
    }
    return json;
  }

 private:
  static constexpr std::string_view kChordal = "chordal+";

  /// The same for every method.
  static void make_garbage(Graph& graph) {
    std::mt19937 engine(1);
    std::normal_distribution<double> normal(0.0, 10.0);
    for (int v = 1; v < graph.vertex_slots(); ++v) {
      double* state = graph.state(v);
      for (int i = 0; i < graph.state_size(v); ++i) state[i] = normal(engine);
      if constexpr (E::kDimension == 6) Eigen::Map<Eigen::Vector4d>(state + 3).normalize();
    }
  }

  Json run(std::string method) const {
    Graph graph = load(file_);
    const int edges = graph.edge_slots();
    const std::vector<EdgeId> added = wrong_.add(graph);
    const std::vector<int> odometry = odometry_edges(graph);
    const std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");
    const bool chordal = method.starts_with(kChordal);
    if (chordal) {
      method.erase(0, kChordal.size());
      make_garbage(graph);
    } else {
      guess_from_odometry(graph);
    }
    const Stopwatch watch;
    std::vector<int> doubted;
    if (chordal) {
      doubted = doubtful_closures(graph, odometry);
      guess_chordal(graph, *solver, doubted);
    }
    const double seconds_for_guess = watch.seconds();
    std::vector<double> weight;
    OptimiserResult result;
    if (method.starts_with("gnc")) {
      GraduationOptions options;
      if (method.starts_with("gnc-geman")) options.kind = Graduation::kGemanMcClure;
      const bool all = method.ends_with(":all");
      options.for_all = chordal;
      const GraduationResult graduated = optimise_graduated(
          graph, options, *solver, all ? std::span<const int>() : std::span<const int>(odometry),
          doubted);
      weight = graduated.weight;
      result = graduated.optimiser;
      result.iterations = graduated.iterations;
    } else {
      const bool closures = method.ends_with(":closures");
      if (closures) method.resize(method.rfind(':'));
      graph.set_kernel(RobustKernel::parse(method));
      if (closures) {
        for (const int slot : odometry) {
          const Graph::EdgeRecord& record = graph.edge_record(slot);
          graph.edge_pools()[record.pool]->kernel(record.index) = RobustKernel();
        }
      }
      result = optimise(graph, {}, *solver);
      weight = weights(graph);
    }
    Json json;
    json["seconds"] = watch.seconds();
    if (chordal) {
      json["seconds_for_guess"] = seconds_for_guess;
      json["doubted_false"] =
          std::count_if(doubted.begin(), doubted.end(), [&](int slot) { return slot >= edges; });
      json["doubted_true"] =
          std::count_if(doubted.begin(), doubted.end(), [&](int slot) { return slot < edges; });
    }
    json["iterations"] = result.iterations;
    json["converged"] = result.converged;
    json["false_kept"] =
        std::count_if(weight.begin() + edges, weight.end(), [](double w) { return w >= 0.5; });
    json["true_rejected"] =
        std::count_if(weight.begin(), weight.begin() + edges, [](double w) { return w < 0.5; });
    double squares = 0.0, largest = 0.0;
    for (int v = 0; v < graph.vertex_slots(); ++v) {
      constexpr int kAxes = E::kDimension == 3 ? 2 : 3;
      double square = 0.0;
      for (int i = 0; i < kAxes; ++i) {
        square += std::pow(graph.state(v)[i] - optimum_.state(v)[i], 2);
      }
      squares += square;
      largest = std::max(largest, std::sqrt(square));
    }
    json["position_rms"] = std::sqrt(squares / graph.vertex_count());
    json["position_max"] = largest;
    for (const EdgeId edge : added) graph.remove_edge(edge);
    json["chi2_ratio"] = chi2(graph) / best_;
    return json;
  }

  /// ρ' of every edge, by slot.
  static std::vector<double> weights(Graph& graph) {
    Problem problem;
    problem.compile(graph);
    Workspace workspace;
    workspace.allocate(problem);
    workspace.load_state();
    workspace.evaluate(workspace.state());
    std::vector<double> weight(graph.edge_slots());
    for (int slot = 0; slot < graph.edge_slots(); ++slot) {
      const Graph::EdgeRecord& record = graph.edge_record(slot);
      const std::vector<int>& compiled = problem.edges()[record.pool].edges;
      const auto k = std::find(compiled.begin(), compiled.end(), record.index) - compiled.begin();
      EdgePool& pool = *graph.edge_pools()[record.pool];
      Eigen::VectorXd e(pool.dimension(record.index));
      workspace.error(record.pool, static_cast<int>(k), e.data());
      weight[slot] =
          pool.kernel(record.index).weights(e.dot(pool.information(record.index) * e)).weight;
    }
    return weight;
  }

  std::filesystem::path file_;
  Graph optimum_;
  double best_ = 0.0;
  FalseClosures<E> wrong_;
};

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  using namespace locograph;
  double fraction = 0.1;
  unsigned seed = 1;
  std::vector<std::filesystem::path> files;
  std::vector<std::string> methods = {"none",
                                      "huber:1",
                                      "cauchy:1",
                                      "geman-mcclure:3",
                                      "dcs:1",
                                      "dcs:1:closures",
                                      "gnc-truncated",
                                      "gnc-geman-mcclure",
                                      "gnc-truncated:all",
                                      "chordal+dcs:1:closures",
                                      "chordal+gnc-truncated"};
  for (const char* name :
       {"manhattan", "intel", "CSAIL", "sphere2500", "torus3D", "parking-garage"}) {
    files.push_back(pose_graph_file(name));
  }
  OptionParser app("Pose graphs with false loop closures", "robustness_benchmark");
  app.add_option("FILE", files, "Pose graphs (.g2o); default: six of the shared data");
  app.add_option("--fraction", fraction, "Of the loop closures that are false, in (0, 1)");
  app.add_option("--seed", seed, "Of the false ones");
  app.add_option("--method", methods, "Only these; a kernel of locograph optimize is one, too")
      .one_at_a_time();
  return run_benchmark(app, argc, argv, [&] {
    if (!(fraction > 0.0 && fraction < 1.0)) {
      throw Error("option --fraction", "a number in (0, 1)");
    }
    Json all = {{"fraction", fraction}, {"seed", seed}};
    all["graphs"] = Json::array();
    for (const std::filesystem::path& file : files) {
      std::cerr << file.filename().string() << "\n";
      const bool planar = !load(file).edges_of<EdgeSE2>().empty();
      all["graphs"].push_back(planar ? Case<EdgeSE2>(file, fraction, seed).run(methods)
                                     : Case<EdgeSE3>(file, fraction, seed).run(methods));
    }
    std::cout << all.dump(1) << "\n";
  });
}
