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

#include <ceres/ceres.h>
#include <locograph/common/deadline.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/chordal_guess.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/slam3d/edges.h>
#include <locograph/types/standard_types.h>
#include <unistd.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "command_line.h"
#include "peer_program.h"
#include "pose_graph_files.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

struct Run {
  double chi2 = 0.0;
  double build_s = 0.0;
  double total_s = 0.0;
  double near_s = 0.0;  ///< to within 0.1 %
  int iterations = 0;
  std::string reason;
  std::vector<double> state;
};

/// When the cost first came within 0.1 % of the last one; pairs of (seconds, cost).
double time_to_near(const std::vector<std::pair<double, double>>& history) {
  for (const auto& [seconds, cost] : history) {
    if (cost <= 1.001 * history.back().second) return seconds;
  }
  return history.back().first;
}

Graph copy_of(const Graph& graph) {
  return read_graph_text(write_graph_text(graph), "copy", ".", standard_types());
}

/// The graph that everybody starts from.
Graph start_of(const std::filesystem::path& file, bool chordal) {
  Graph graph = read_graph(file, standard_types(), {.lenient = true});
  graph.set_fixed(0, true);
  if (chordal) guess_chordal(graph, *make_linear_solver("auto"));
  return graph;
}

Run finished(std::vector<std::pair<double, double>> history) {
  Run run;
  run.total_s = history.back().first;
  run.chi2 = history.back().second;
  run.near_s = time_to_near(history);
  return run;
}

Run run_locograph(const Graph& start, int threads, std::string* solver_name) {
  Graph graph = copy_of(start);
  OptimiserOptions options;
  options.gain = 1e-7;
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

  Run run = finished(std::move(history));
  run.build_s = compiled;
  run.iterations = optimiser.result().iterations;
  run.reason = optimiser.result().reason_text();
  run.state = workspace.state();
  *solver_name = solver->name();
  return run;
}

/// A matrix S with SᵀS = Ω; Ω may be semi-definite.
template <int N>
Eigen::Matrix<double, N, N> square_root(const Eigen::Matrix<double, N, N>& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information);
  return solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         solver.eigenvectors().transpose();
}

/// locograph's error of edge type E, for Ceres.
template <class E, class V>
struct Residual {
  const E* edge;
  Eigen::Matrix<double, E::kDimension, E::kDimension> root;

  template <class T>
  bool operator()(const T* a, const T* b, T* residual) const {
    Eigen::Matrix<T, E::kDimension, 1> e;
    edge->template error<T>(V::template view<T>(a), V::template view<T>(b), e);
    Eigen::Map<Eigen::Matrix<T, E::kDimension, 1>> weighted(residual);
    weighted = root.template cast<T>() * e;
    return true;
  }
};

template <class E, class V>
void add_edges(Graph& graph, std::vector<typename V::State>& states, ceres::Problem& problem,
               std::vector<double*>& place) {
  for (const V& vertex : graph.vertices_of<V>()) states.push_back(vertex.state);
  for (int slot = 0; slot < graph.vertex_slots(); ++slot) {
    place.push_back(states[graph.vertex_record(slot).index].data());
  }
  for (const E& edge : graph.edges_of<E>()) {
    using Function = Residual<E, V>;
    using Cost = ceres::AutoDiffCostFunction<Function, E::kDimension, V::kStateSize, V::kStateSize>;
    problem.AddResidualBlock(new Cost(new Function{&edge, square_root(edge.information)}), nullptr,
                             place[edge.vertices[0]], place[edge.vertices[1]]);
  }
}

Run run_ceres(const Graph& start) {
  Graph graph = copy_of(start);
  const Stopwatch build;
  ceres::Problem problem;
  std::vector<double*> place;
  std::vector<Eigen::Vector3d> planar;
  std::vector<VertexSE3::State> spatial;
  if (!graph.edges_of<EdgeSE3>().empty()) {
    spatial.reserve(graph.vertex_count());
    add_edges<EdgeSE3, VertexSE3>(graph, spatial, problem, place);
    using Manifold =
        ceres::ProductManifold<ceres::EuclideanManifold<3>, ceres::EigenQuaternionManifold>;
    auto* manifold = new Manifold();  // owned by the problem
    for (double* block : place) {
      if (problem.HasParameterBlock(block)) problem.SetManifold(block, manifold);
    }
  } else {
    planar.reserve(graph.vertex_count());
    add_edges<EdgeSE2, VertexSE2>(graph, planar, problem, place);
  }
  problem.SetParameterBlockConstant(place[0]);

  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  options.num_threads = 1;
  options.max_num_iterations = 300;
  options.function_tolerance = 1e-7;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  Run run;
  run.build_s = build.seconds();
  const Stopwatch watch;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  run.total_s = watch.seconds();
  run.chi2 = 2.0 * summary.final_cost;
  std::vector<std::pair<double, double>> history;
  for (const ceres::IterationSummary& iteration : summary.iterations) {
    history.emplace_back(iteration.cumulative_time_in_seconds,
                         iteration.step_is_successful || iteration.iteration == 0
                             ? iteration.cost
                             : history.back().second);
  }
  history.emplace_back(run.total_s, std::min(history.back().second, summary.final_cost));
  run.near_s = time_to_near(history);
  run.iterations = summary.num_successful_steps;
  run.reason = summary.message;
  return run;
}

double median(const std::vector<Run>& runs, double Run::*value) {
  std::vector<double> values;
  for (const Run& run : runs) values.push_back(run.*value);
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Json report(const std::vector<Run>& runs) {
  Json json;
  json["chi2"] = runs[0].chi2;
  if (runs[0].iterations > 0) json["iterations"] = runs[0].iterations;
  if (!runs[0].reason.empty()) json["reason"] = runs[0].reason;
  json["time_to_0.1%"] = median(runs, &Run::near_s);
  json["total"] = median(runs, &Run::total_s);
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
  std::vector<Run> one, two, ceres;
  std::vector<std::vector<Run>> peers(options.peers.size());
  std::string solver;
  // Alternating, so that all see the same state of the machine.
  for (int i = 0; i < options.runs; ++i) {
    one.push_back(run_locograph(start, 1, &solver));
    two.push_back(run_locograph(start, 2, &solver));
    ceres.push_back(run_ceres(start));
    for (std::size_t p = 0; p < peers.size(); ++p) {
      auto history = run_peer(options.peers[p], copy);
      if (!history.empty()) peers[p].push_back(finished(std::move(history)));
    }
  }
  std::filesystem::remove(copy);
  Json json;
  json["file"] = file.filename().string();
  json["locograph"] = report(one);
  json["locograph"]["linear_solver"] = solver;
  json["locograph"]["compile"] = median(one, &Run::build_s);
  json["two_threads"] = {{"total", median(two, &Run::total_s)},
                         {"speed_up", median(one, &Run::total_s) / median(two, &Run::total_s)},
                         {"same_bits", one[0].state == two[0].state}};
  const double ours = median(one, &Run::near_s);
  const auto add = [&](const std::string& name, const std::vector<Run>& theirs) {
    if (theirs.empty()) {
      json[name] = nullptr;
      return;
    }
    json[name] = report(theirs);
    json[name]["ratio"] = median(theirs, &Run::near_s) / ours;
    ratios[name].push_back(median(theirs, &Run::near_s) / ours);
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
