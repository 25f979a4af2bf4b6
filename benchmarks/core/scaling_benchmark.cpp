/// Time and memory of grid pose graphs from a thousand to a million poses.
///
///     scaling_benchmark [--spatial] [--solvers auto,pcg] [--threads N] [--ceres-up-to N] [POSES…]
///
/// A square grid of poses driven line by line, each tied to its neighbours left and below by noisy
/// measurements (1 % noise); the start is the truth with noise of 5 cm and 0.05 rad. Each size and
/// solver runs in a process of its own, for its peak memory. Prints one JSON object; times in
/// seconds.

#include <ceres/ceres.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/slam3d/edges.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>

#include "command_line.h"
#include "started_run.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  bool spatial = false;
  int threads = 1;
  int ceres_up_to = 100000;
  std::vector<std::string> solvers{"auto", "pcg"};
  std::vector<int> sizes{1000, 3000, 10000, 30000, 100000, 300000, 1000000};
};

double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// Planar or spatial poses of a grid, by the same measurements.
template <class V, class E, class Pose>
class Grid {
 public:
  Grid(int size,
       Pose (*make)(double x, double y, double heading, std::mt19937& engine, double noise))
      : side_(static_cast<int>(std::lround(std::sqrt(size)))) {
    std::mt19937 engine(1);
    std::vector<Pose> truth;
    for (int i = 0; i < side_ * side_; ++i) {
      const int row = i / side_, step = i % side_;
      const bool forth = row % 2 == 0;
      truth.push_back(make(forth ? step : side_ - 1 - step, row, forth ? 0.0 : M_PI, engine, 0.0));
      ids_.push_back(graph_.add_vertex(
          i, V(i == 0 ? truth[0] : truth[i] * make(0.0, 0.0, 0.0, engine, 0.05))));
    }
    const auto tie = [&](int a, int b) {
      E edge;
      edge.measurement = truth[a].inverse() * truth[b] * make(0.0, 0.0, 0.0, engine, 0.01);
      edge.information *= 1e4;
      graph_.add_edge(edge, ids_[a], ids_[b]);
    };
    for (int i = 1; i < side_ * side_; ++i) {
      tie(i - 1, i);
      const int row = i / side_, step = i % side_;
      if (row > 0 && step > 0) tie(row * side_ - 1 - step, i);
    }
    graph_.set_fixed(ids_[0], true);
  }
  Graph& graph() { return graph_; }

 private:
  int side_;
  Graph graph_;
  std::vector<VertexId<V>> ids_;
};

SE2<double> planar(double x, double y, double heading, std::mt19937& engine, double noise) {
  std::normal_distribution<double> normal;
  const auto error = [&] { return noise * normal(engine); };
  const double dx = error(), dy = error(), turn = error();
  return SE2<double>(x + dx, y + dy, heading + turn);
}

SE3<double> spatial(double x, double y, double heading, std::mt19937& engine, double noise) {
  std::normal_distribution<double> normal;
  const auto error = [&] { return noise * normal(engine); };
  const Eigen::Vector3d shift(error(), error(), error()), turn(error(), error(), error());
  return SE3<double>(Eigen::Vector3d(x, y, 0.0) + shift,
                     Eigen::Quaterniond(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ())) *
                         quaternion_exp<double>(turn));
}

Json optimise_grid(Graph& graph, const std::string& solver_name, int threads) {
  const double before = peak_bytes();
  OptimiserOptions options;
  options.gain = 1e-6;
  StartedRun run(graph, options, solver_name, threads);
  while (run.optimiser.iterate()) {
  }
  const double total = run.watch.seconds();
  const OptimiserResult& result = run.optimiser.result();
  double linearise = 0.0, solve = 0.0;
  for (const IterationStatistics& now : result.statistics) {
    linearise += now.time_linearise;
    solve += now.time_solve;
  }
  const double poses = graph.vertex_count();
  return {{"poses", graph.vertex_count()},
          {"edges", graph.edge_count()},
          {"solver", run.solver->name()},
          {"threads", threads},
          {"chi2", result.final.chi2},
          {"iterations", result.iterations},
          {"converged", result.converged},
          {"compile", run.compiled_s},
          {"analyse", run.started_s - run.compiled_s},
          {"linearise", linearise},
          {"solve", solve},
          {"total", total},
          {"microseconds_per_pose", 1e6 * total / poses},
          {"graph_bytes_per_pose", before / poses},
          {"peak_bytes_per_pose", peak_bytes() / poses}};
}

/// The same grid by Ceres, planar only: locograph's error evaluated on ceres::Jet.
struct PlanarResidual {
  const EdgeSE2* edge;
  template <class T>
  bool operator()(const T* a, const T* b, T* residual) const {
    Eigen::Map<Eigen::Matrix<T, 3, 1>> e(residual);
    Eigen::Matrix<T, 3, 1> error;
    edge->error<T>(VertexSE2::view<T>(a), VertexSE2::view<T>(b), error);
    e = T(std::sqrt(edge->information(0, 0))) * error;
    return true;
  }
};

Json ceres_grid(Graph& graph) {
  std::vector<Eigen::Vector3d> states;
  for (const VertexSE2& vertex : graph.vertices_of<VertexSE2>()) states.push_back(vertex.state);
  const Stopwatch watch;
  ceres::Problem problem;
  for (const EdgeSE2& edge : graph.edges_of<EdgeSE2>()) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<PlanarResidual, 3, 3, 3>(new PlanarResidual{&edge}),
        nullptr, states[edge.vertices[0]].data(), states[edge.vertices[1]].data());
  }
  problem.SetParameterBlockConstant(states[0].data());
  const double build = watch.seconds();
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.function_tolerance = 1e-6;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return {{"poses", graph.vertex_count()},
          {"solver", "ceres"},
          {"chi2", 2.0 * summary.final_cost},
          {"iterations", summary.num_successful_steps},
          {"build", build},
          {"total", watch.seconds()},
          {"peak_bytes_per_pose", peak_bytes() / graph.vertex_count()}};
}

Json measure(int size, const std::string& solver, const Options& options) {
  if (options.spatial) {
    Grid<VertexSE3, EdgeSE3, SE3<double>> grid(size, spatial);
    return optimise_grid(grid.graph(), solver, options.threads);
  }
  Grid<VertexSE2, EdgeSE2, SE2<double>> grid(size, planar);
  if (solver == "ceres") return ceres_grid(grid.graph());
  return optimise_grid(grid.graph(), solver, options.threads);
}

/// What `measure` returns, from a child process.
Json in_a_process(int size, const std::string& solver, const Options& options) {
  int ends[2];
  if (pipe(ends) != 0) throw Error("no pipe", "one");
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    std::string text;
    try {
      text = measure(size, solver, options).dump();
    } catch (const std::exception& error) {
      text = Json{{"poses", size}, {"solver", solver}, {"error", error.what()}}.dump();
    }
    const bool written = write(ends[1], text.data(), text.size()) == ssize_t(text.size());
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) > 0;) text.append(buffer, n);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (text.empty()) return {{"poses", size}, {"solver", solver}, {"error", "the process ended"}};
  return Json::parse(text);
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  using namespace locograph;
  Options options;
  OptionParser app("Grid pose graphs by size", "scaling_benchmark");
  app.add_option("POSES", options.sizes, "Sizes").between(4, 1 << 30);
  app.add_flag("--spatial", options.spatial, "SE(3) instead of SE(2)");
  app.add_option("--threads", options.threads, "Threads to use").positive();
  app.add_option("--ceres-up-to", options.ceres_up_to, "Largest size for Ceres");
  app.add_option("--solvers", options.solvers, "Linear solvers, separated by commas")
      .separated_by(',')
      .one_at_a_time();
  return run_benchmark(app, argc, argv, [&] {
    Json all = {{"unit", "s"}, {"kind", options.spatial ? "SE(3)" : "SE(2)"}};
    for (const int size : options.sizes) {
      std::vector<std::string> solvers = options.solvers;
      if (!options.spatial && size <= options.ceres_up_to) solvers.push_back("ceres");
      for (const std::string& solver : solvers) {
        all["runs"].push_back(in_a_process(size, solver, options));
        std::cerr << all["runs"].back().dump() << "\n";
      }
    }
    std::cout << all.dump(1) << "\n";
  });
}
