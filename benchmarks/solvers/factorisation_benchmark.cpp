/// Analysis, factorisation and solution of the normal equations of pose graphs at their initial
/// values: our block Cholesky on one and two threads, CHOLMOD (simplicial and supernodal) and
/// Eigen, in the same run.
///
///     factorisation_benchmark [--runs N] [--peers no] [FILE.g2o…]   # default: the shared data
///
/// Prints one JSON object: medians in milliseconds, and ratios to ours on one thread. The peers'
/// factorisation includes copying the values into their matrix, as ours does.

#include <locograph/common/deadline.h>
#include <locograph/solvers/block_cholesky.h>
#include <locograph/solvers/eigen_solver.h>
#if LOCOGRAPH_HAVE_CHOLMOD
#include <locograph/solvers/cholmod_solver.h>
#endif

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>

#include "command_line.h"
#include "linearised_graph.h"
#include "pose_graph_files.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

/// Median milliseconds of `runs` calls, repeated until each measurement takes a millisecond.
double median(int runs, const std::function<void()>& work) {
  const Stopwatch first;
  work();
  const int repeats = 1 + static_cast<int>(1e-3 / std::max(first.seconds(), 1e-7));
  std::vector<double> times;
  for (int i = 0; i < runs; ++i) {
    const Stopwatch watch;
    for (int r = 0; r < repeats; ++r) work();
    times.push_back(1e3 * watch.seconds() / repeats);
  }
  std::nth_element(times.begin(), times.begin() + runs / 2, times.end());
  return times[runs / 2];
}

using Make = std::function<std::unique_ptr<LinearSolver>()>;

Json measure(LinearisedGraph& system, int runs, const Make& make, ThreadPool* threads = nullptr) {
  const BlockPattern& pattern = system.problem.pattern();
  std::unique_ptr<LinearSolver> solver = make();
  solver->use_threads(threads);
  solver->analyse(pattern);
  Json json;
  json["analyse"] = median(std::min(runs, 5), [&] { make()->analyse(pattern); });
  json["factorise"] = median(runs, [&] {
    if (!solver->factorise(system.workspace.hessian().data(), system.damping.data())) {
      throw Error("a factorisation failed", "a positive definite matrix");
    }
  });
  json["solve"] = median(runs, [&] {
    solver->solve(system.workspace.gradient().data(), system.workspace.step().data());
  });
  return json;
}

Json compare(const std::filesystem::path& file, int runs, bool peers) {
  LinearisedGraph system(file);
  const auto ours = [] { return std::make_unique<BlockCholesky>(); };
  BlockCholesky solver;
  solver.analyse(system.problem.pattern());
  ThreadPool threads(2);
  Json json;
  json["file"] = file.filename().string();
  json["blocks"] = system.problem.pattern().size();
  json["dimension"] = system.problem.dimension();
  json["order"] = solver.order();
  json["supernodes"] = solver.structure().count();
  json["factor_size"] = solver.factor_size();
  json["multiply_adds"] = solver.multiply_adds();
  json["estimated_ms"] = 1e3 * solver.seconds();
  Json one = measure(system, runs, ours), two = measure(system, runs, ours, &threads);
  json["gigaflops"] = 2e-6 * solver.multiply_adds() / one["factorise"].get<double>();
  json["ours"] = one;
  json["ours_two_threads"] = two;
  const auto ratio = [&](const char* phase, const Json& other) {
    return other[phase].get<double>() / one[phase].get<double>();
  };
  json["one_over_two_threads"] = 1.0 / ratio("factorise", two);
  if (!peers) return json;
  const auto add = [&](const char* name, const Make& make) {
    json[name] = measure(system, std::max(1, runs / 3), make);
    for (const char* phase : {"analyse", "factorise", "solve"}) {
      json[std::string(name) + "_over_ours"][phase] = ratio(phase, json[name]);
    }
  };
#if LOCOGRAPH_HAVE_CHOLMOD
  using Mode = CholmodSolver::Mode;
  add("cholmod_simplicial", [] { return std::make_unique<CholmodSolver>(Mode::simplicial); });
  add("cholmod_supernodal", [] { return std::make_unique<CholmodSolver>(Mode::supernodal); });
#endif
  add("eigen", [] { return std::make_unique<EigenSolver>(); });
  return json;
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  using namespace locograph;
  int runs = 15;
  bool peers = true;
  std::vector<std::filesystem::path> files = pose_graph_files();
  OptionParser app("Factorisations of pose graphs", "factorisation_benchmark");
  app.add_option("FILE", files, "Pose graphs (.g2o); default: the shared data");
  app.add_option("--runs", runs, "Measurements of each").positive();
  app.add_option("--peers", peers, "Measure CHOLMOD and Eigen as well");
  return run_benchmark(app, argc, argv, [&] {
    if (files.empty()) throw Error("no graph files", "FILE.g2o arguments");
    Json all = {{"unit", "ms"}, {"runs", runs}};
    all["graphs"] = Json::array();
    for (const std::filesystem::path& file : files) {
      std::cerr << file.filename().string() << "\n";
      all["graphs"].push_back(compare(file, runs, peers));
    }
    std::cout << all.dump(1) << "\n";
  });
}
