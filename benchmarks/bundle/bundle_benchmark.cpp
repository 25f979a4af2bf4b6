/// Bundle adjustment to convergence: locograph's Schur solvers against those of Ceres on the same
/// problem, from the same initial values, in the same run.
///
///     bundle_benchmark [--cameras N] [--points N] [--seed N] [--runs N] [--threads N]
///                      [--skip SOLVER]… [BAL.txt…]
///
/// Without files: dubrovnik-3-7 of the shared data and a generated problem (generated_bundle.h; 500
/// cameras, 100 000 points, about 600 000 observations). Prints one JSON object. Times in seconds,
/// median of the runs; `time_to_0.1%` is to the first accepted step whose cost is within 0.1 % of
/// the lowest cost that anybody reached. For locograph it includes compiling the problem; for Ceres
/// it is what Solver::Solve takes, its preprocessing included, building the ceres::Problem not.
/// `ceres` differentiates automatically, as its users do; `ceres_analytic` is given locograph's own
/// Jacobians. Both damp by the diagonal of H, from the same first λ.

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <locograph/common/deadline.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/bundle/camera_bal.h>

#include <algorithm>
#include <ctime>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>

#include "command_line.h"
#include "generated_bundle.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

struct Settings {
  int runs = 1, threads = 1;
  std::set<std::string> skip;  ///< linear solvers left out
};

struct Run {
  double cost = 0.0;  ///< Σ |e|²
  double build_s = 0.0, total_s = 0.0;
  double cpu_s = 0.0;  ///< of the processor in total_s: comparable also on a busy machine
  int iterations = 0;
  std::string reason, solver;
  std::vector<std::pair<double, double>> history;  ///< (seconds, cost)
  double linearise_s = 0.0, solve_s = 0.0;

  double time_to(double cost_asked) const {
    for (const auto& [seconds, cost_then] : history) {
      if (cost_then <= cost_asked) return seconds;
    }
    return std::numeric_limits<double>::infinity();
  }
};

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Graph make_graph(const BundleProblem& problem) {
  Graph graph;
  std::vector<VertexId<VertexCameraBAL>> cameras;
  std::vector<VertexId<VertexPointXYZ>> points;
  int id = 0;
  for (const auto& camera : problem.cameras) {
    cameras.push_back(graph.add_vertex(id++, VertexCameraBAL(camera)));
  }
  for (const Eigen::Vector3d& point : problem.points) {
    points.push_back(graph.add_vertex(id++, VertexPointXYZ(point)));
    graph.set_eliminate(points.back().slot, true);
  }
  for (const BundleProblem::Observation& o : problem.observations) {
    EdgeProjectBAL edge;
    edge.measurement << o.x, o.y;
    graph.add_edge(edge, cameras[o.camera], points[o.point]);
  }
  return graph;
}

Run run_locograph(const BundleProblem& bundle, const std::string& solver_name, int thread_count) {
  Run run;
  Stopwatch watch;
  Graph graph = make_graph(bundle);
  run.build_s = watch.lap();
  const double cpu = processor_seconds();
  ThreadPool threads(thread_count);
  OptimiserOptions options;
  options.max_iterations = 50;
  options.gain = 1e-7;
  // Rotations, pixels and distortions have no common unit: damp each by its own curvature, as Ceres
  // does.
  options.scale_by_diagonal = true;
  options.initial_lambda = 1e-4;
  const std::unique_ptr<LinearSolver> solver = make_linear_solver(solver_name);
  solver->use_threads(&threads);
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  Optimiser optimiser(options);
  optimiser.start(workspace, *solver);
  run.history.emplace_back(watch.seconds(), optimiser.result().initial.chi2);
  bool more = true;
  while (more) {
    more = optimiser.iterate();
    run.history.emplace_back(watch.seconds(), optimiser.result().final.chi2);
  }
  workspace.store_state();
  run.total_s = watch.seconds();
  run.cpu_s = processor_seconds() - cpu;
  const OptimiserResult& result = optimiser.result();
  run.cost = result.final.chi2;
  run.iterations = result.iterations;
  run.reason = result.reason_text();
  run.solver = solver->name();
  for (const IterationStatistics& now : result.statistics) {
    run.linearise_s += now.time_linearise + now.time_evaluate;
    run.solve_s += now.time_solve;
  }
  return run;
}

/// The camera model of BAL for automatic differentiation.
struct Reprojection {
  double x, y;

  template <class T>
  bool operator()(const T* camera, const T* point, T* residual) const {
    T p[3];
    ceres::AngleAxisRotatePoint(camera, point, p);
    for (int i = 0; i < 3; ++i) p[i] += camera[3 + i];
    const T u = -p[0] / p[2], v = -p[1] / p[2];
    const T r2 = u * u + v * v;
    const T scale = camera[6] * (T(1.0) + r2 * (camera[7] + r2 * camera[8]));
    residual[0] = scale * u - T(x);
    residual[1] = scale * v - T(y);
    return true;
  }
};

/// locograph's error and Jacobians.
class AnalyticReprojection final : public ceres::SizedCostFunction<2, 9, 3> {
 public:
  AnalyticReprojection(double x, double y) { edge_.measurement << x, y; }
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    VertexCameraBAL::Derived camera;
    model_.derive(parameters[0], camera);
    const Eigen::Vector3d point(parameters[1]);
    edge_.error(camera, point, Eigen::Map<Eigen::Vector2d>(residuals));
    if (jacobians == nullptr) return true;
    Eigen::Matrix<double, 2, 9> by_camera;
    Eigen::Matrix<double, 2, 3> by_point;
    edge_.jacobians(camera, point, by_camera, by_point);
    if (jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 2, 9, Eigen::RowMajor>> out(jacobians[0]);
      out = by_camera;
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 2, 3, Eigen::RowMajor>> out(jacobians[1]);
      out = by_point;
    }
    return true;
  }

 private:
  VertexCameraBAL model_;
  EdgeProjectBAL edge_;
};

Run run_ceres(const BundleProblem& bundle, ceres::LinearSolverType type, bool analytic,
              int thread_count) {
  Run run;
  const Stopwatch build;
  BundleProblem state = bundle;
  ceres::Problem problem;
  auto* ordering = new ceres::ParameterBlockOrdering;  // owned by the options
  for (const BundleProblem::Observation& o : state.observations) {
    ceres::CostFunction* function =
        analytic
            ? static_cast<ceres::CostFunction*>(new AnalyticReprojection(o.x, o.y))
            : new ceres::AutoDiffCostFunction<Reprojection, 2, 9, 3>(new Reprojection{o.x, o.y});
    problem.AddResidualBlock(function, nullptr, state.cameras[o.camera].data(),
                             state.points[o.point].data());
  }
  for (auto& point : state.points) {
    if (problem.HasParameterBlock(point.data())) ordering->AddElementToGroup(point.data(), 0);
  }
  for (auto& camera : state.cameras) {
    if (problem.HasParameterBlock(camera.data())) ordering->AddElementToGroup(camera.data(), 1);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = type;
  options.preconditioner_type = ceres::SCHUR_JACOBI;
  options.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  options.linear_solver_ordering.reset(ordering);
  options.num_threads = thread_count;
  options.max_num_iterations = 50;
  options.function_tolerance = 1e-7;
  options.gradient_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  run.build_s = build.seconds();
  const Stopwatch watch;
  const double cpu = processor_seconds();
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  run.cpu_s = processor_seconds() - cpu;
  run.total_s = watch.seconds();
  run.cost = 2.0 * summary.final_cost;
  for (const ceres::IterationSummary& iteration : summary.iterations) {
    if (!iteration.step_is_successful && iteration.iteration > 0) continue;
    run.history.emplace_back(iteration.cumulative_time_in_seconds, 2.0 * iteration.cost);
  }
  run.history.emplace_back(run.total_s, run.cost);
  run.iterations = summary.num_successful_steps;
  run.reason = summary.message;
  run.solver = ceres::LinearSolverTypeToString(type);
  run.linearise_s =
      summary.jacobian_evaluation_time_in_seconds + summary.residual_evaluation_time_in_seconds;
  run.solve_s = summary.linear_solver_time_in_seconds;
  return run;
}

struct Contender {
  std::string family;  ///< locograph, ceres, ceres_analytic
  std::function<Run()> run;
  std::vector<Run> runs;
};

template <class Value>
double median(const std::vector<Run>& runs, Value&& value) {
  std::vector<double> values;
  for (const Run& run : runs) values.push_back(value(run));
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Json compare(const std::string& name, const BundleProblem& bundle, const Settings& settings) {
  const int threads = settings.threads;
  std::vector<Contender> all;
  for (const char* solver : {"schur-sparse", "schur-dense", "schur-pcg", "auto"}) {
    if (settings.skip.count(solver) > 0) continue;
    all.push_back({"locograph",
                   [&bundle, solver, threads] { return run_locograph(bundle, solver, threads); },
                   {}});
  }
  for (const bool analytic : {false, true}) {
    for (const ceres::LinearSolverType type :
         {ceres::DENSE_SCHUR, ceres::SPARSE_SCHUR, ceres::ITERATIVE_SCHUR}) {
      if (settings.skip.count(ceres::LinearSolverTypeToString(type)) > 0) continue;
      all.push_back({analytic ? "ceres_analytic" : "ceres",
                     [&bundle, type, analytic, threads] {
                       return run_ceres(bundle, type, analytic, threads);
                     },
                     {}});
    }
  }
  // Round by round, so that all see the same state of the machine.
  for (int i = 0; i < settings.runs; ++i) {
    for (Contender& contender : all) {
      contender.runs.push_back(contender.run());
      const Run& run = contender.runs.back();
      std::cerr << "  " << contender.family << " " << run.solver << ": cost " << run.cost << ", "
                << run.total_s << " s (processor " << run.cpu_s << " s), " << run.iterations
                << " steps\n";
    }
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (const Contender& contender : all) lowest = std::min(lowest, contender.runs[0].cost);

  Json json = {{"problem", name},
               {"cameras", bundle.cameras.size()},
               {"points", bundle.points.size()},
               {"observations", bundle.observations.size()},
               {"residuals", 2 * bundle.observations.size()},
               {"unknowns", 9 * bundle.cameras.size() + 3 * bundle.points.size()},
               {"lowest_cost", lowest}};
  Json results = Json::array();
  std::map<std::string, double> best_near, best_total, best_cpu;
  for (const Contender& contender : all) {
    const Run& first = contender.runs[0];
    const double near =
        median(contender.runs, [&](const Run& run) { return run.time_to(1.001 * lowest); });
    const double total = median(contender.runs, [](const Run& run) { return run.total_s; });
    const double cpu = median(contender.runs, [](const Run& run) { return run.cpu_s; });
    Json one = {{"by", contender.family},
                {"linear_solver", first.solver},
                {"cost", first.cost},
                {"relative_excess", first.cost / lowest - 1.0},
                {"iterations", first.iterations},
                {"reason", first.reason},
                {"build", median(contender.runs, [](const Run& run) { return run.build_s; })}};
    one["time_to_0.1%"] = std::isfinite(near) ? Json(near) : Json(nullptr);
    one["total"] = total;
    one["processor"] = cpu;
    one["linearise"] = median(contender.runs, [](const Run& run) { return run.linearise_s; });
    one["solve"] = median(contender.runs, [](const Run& run) { return run.solve_s; });
    results.push_back(one);
    const auto better = [&](std::map<std::string, double>& best, double value) {
      const auto [at, added] = best.emplace(contender.family, value);
      if (!added) at->second = std::min(at->second, value);
    };
    better(best_near, near);
    better(best_total, total);
    better(best_cpu, cpu);
  }
  json["results"] = results;
  for (const char* family : {"ceres", "ceres_analytic"}) {
    if (best_near.count(family) == 0) continue;
    json[std::string(family) + "_over_locograph"] = {
        {"time_to_0.1%", best_near[family] / best_near["locograph"]},
        {"total", best_total[family] / best_total["locograph"]},
        {"processor", best_cpu[family] / best_cpu["locograph"]}};
  }
  return json;
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  using namespace locograph;
  Settings settings;
  BundleOptions generated;
  std::vector<std::filesystem::path> files;
  std::vector<std::string> skip;
  OptionParser app("Bundle adjustment to convergence", "bundle_benchmark");
  app.add_option("BAL", files, "Problems; default: one of the shared data and a generated one");
  app.add_option("--cameras", generated.cameras, "Generated").positive();
  app.add_option("--points", generated.points, "Generated").positive();
  app.add_option("--seed", generated.seed, "Of what is generated").positive();
  app.add_option("--runs", settings.runs, "Measurements of each").positive();
  app.add_option("--threads", settings.threads, "Threads to use").positive();
  app.add_option("--skip", skip, "A linear solver to leave out").one_at_a_time();
  return run_benchmark(app, argc, argv, [&] {
    settings.skip = {skip.begin(), skip.end()};
    Json all = {{"unit", "s"}, {"threads", settings.threads}, {"runs", settings.runs}};
    all["problems"] = Json::array();
    const bool given = !files.empty();
    if (!given) {
      files.push_back(std::filesystem::path(LOCOGRAPH_SHARED_DATA) /
                      "bundle/dubrovnik-3-7-pre.txt");
      if (!std::filesystem::exists(files.back())) files.clear();
    }
    for (const std::filesystem::path& file : files) {
      std::cerr << file.filename().string() << "\n";
      all["problems"].push_back(compare(file.filename().string(), load_bundle(file), settings));
    }
    if (!given) {
      std::cerr << "generated\n";
      all["problems"].push_back(compare("generated", generate_bundle(generated), settings));
    }
    std::cout << all.dump(1) << "\n";
  });
}
