/// Pose graphs to convergence: locograph (Levenberg-Marquardt, default options) against Ceres on
/// the same problem, from the same initial values, in the same run, one thread each.
///
///     pose_graph_benchmark [--runs N] [FILE.g2o…]      # default: all public files of shared data
///
/// Prints one JSON object. Times in seconds, median of the runs; `time_to_0.1%` is from the loaded
/// graph to the first accepted step whose cost is within 0.1 % of the value that optimiser
/// converges to. For locograph this includes compiling the problem; for Ceres it is what
/// Solver::Solve takes, its preprocessing included, building the ceres::Problem not (reported as
/// `build`). Both see the same error: the residual of Ceres is locograph's own error() evaluated on
/// ceres::Jet, times a square root of Ω.

#include <ceres/ceres.h>
#include <locograph/common/deadline.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/slam3d/edges.h>
#include <locograph/types/standard_types.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

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
};

/// When the cost first came within 0.1 % of the last one; pairs of (seconds, cost).
double time_to_near(const std::vector<std::pair<double, double>>& history) {
  for (const auto& [seconds, cost] : history) {
    if (cost <= 1.001 * history.back().second) return seconds;
  }
  return history.back().first;
}

Run run_locograph(const std::filesystem::path& file, std::string* solver_name) {
  Graph graph = read_graph(file, standard_types(), {.lenient = true});
  graph.set_fixed(0, true);
  OptimiserOptions options;
  std::vector<std::pair<double, double>> history;
  history.reserve(options.max_iterations + 1);
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");

  const Stopwatch watch;
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  Optimiser optimiser(options);
  const double compiled = watch.seconds();
  optimiser.start(workspace, *solver);
  history.emplace_back(watch.seconds(), optimiser.result().initial.chi2);
  while (optimiser.iterate()) {
    history.emplace_back(watch.seconds(), optimiser.result().final.chi2);
  }
  history.emplace_back(watch.seconds(), optimiser.result().final.chi2);
  workspace.store_state();

  Run run;
  run.total_s = watch.seconds();
  run.build_s = compiled;
  run.chi2 = optimiser.result().final.chi2;
  run.near_s = time_to_near(history);
  run.iterations = optimiser.result().iterations;
  run.reason = optimiser.result().reason_text();
  *solver_name = solver->name();
  return run;
}

/// A matrix S with SᵀS = Ω; Ω may be semi-definite.
template <int N>
Eigen::Matrix<double, N, N> square_root(const Eigen::Matrix<double, N, N>& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> solver(information);
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

Run run_ceres(const std::filesystem::path& file) {
  Graph graph = read_graph(file, standard_types(), {.lenient = true});
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

double median(std::vector<Run>& runs, double Run::*value) {
  std::sort(runs.begin(), runs.end(),
            [&](const Run& a, const Run& b) { return a.*value < b.*value; });
  return runs[runs.size() / 2].*value;
}

Json report(std::vector<Run>& runs) {
  Json json;
  json["chi2"] = runs[0].chi2;
  json["iterations"] = runs[0].iterations;
  json["reason"] = runs[0].reason;
  json["build"] = median(runs, &Run::build_s);
  json["time_to_0.1%"] = median(runs, &Run::near_s);
  json["total"] = median(runs, &Run::total_s);
  return json;
}

Json compare(const std::filesystem::path& file, int runs) {
  std::vector<Run> ours, theirs;
  std::string solver;
  // Alternating, so that both see the same state of the machine.
  for (int i = 0; i < runs; ++i) {
    ours.push_back(run_locograph(file, &solver));
    theirs.push_back(run_ceres(file));
  }
  Json json;
  json["file"] = file.filename().string();
  json["locograph"] = report(ours);
  json["locograph"]["linear_solver"] = solver;
  json["ceres"] = report(theirs);
  const double a = ours[0].chi2, b = theirs[0].chi2;
  json["same_optimum"] = std::abs(a - b) <= 1e-3 * std::min(a, b);
  json["ceres_over_locograph"]["time_to_0.1%"] =
      median(theirs, &Run::near_s) / median(ours, &Run::near_s);
  json["ceres_over_locograph"]["total"] =
      median(theirs, &Run::total_s) / median(ours, &Run::total_s);
  return json;
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  int runs = 3;
  std::vector<std::filesystem::path> files;
  try {
    for (int i = 1; i < argc; ++i) {
      const std::string argument = argv[i];
      if (argument == "--runs") {
        runs = i + 1 < argc ? std::atoi(argv[++i]) : 0;
        if (runs < 1) throw locograph::Error("option --runs", "a number of 1 or more");
      } else {
        files.emplace_back(argument);
      }
    }
    if (files.empty()) {
      const std::filesystem::path folder =
          std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "pose_graphs";
      if (std::filesystem::exists(folder)) {
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
          if (entry.path().extension() == ".g2o") files.push_back(entry.path());
        }
      }
      std::sort(files.begin(), files.end());
    }
    if (files.empty()) throw locograph::Error("no graph files", "FILE.g2o arguments");
    locograph::Json all = {{"unit", "s"}, {"threads", 1}, {"runs", runs}};
    all["graphs"] = locograph::Json::array();
    for (const std::filesystem::path& file : files) {
      std::cerr << file.filename().string() << "\n";
      all["graphs"].push_back(locograph::compare(file, runs));
    }
    std::cout << all.dump(1) << "\n";
  } catch (const locograph::Error& error) {
    std::cerr << "pose_graph_benchmark: " << error.what() << "\n";
    return 2;
  }
  return 0;
}
