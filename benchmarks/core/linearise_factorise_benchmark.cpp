/// One linearisation (ns per edge), one evaluation, one factorisation and one solve of the public
/// pose graphs, at their initial values.
///
///     linearise_factorise_benchmark --benchmark_format=json

#include <benchmark/benchmark.h>
#include <locograph/solvers/linear_solvers.h>

#include <filesystem>
#include <memory>
#include <string>

#include "linearised_graph.h"
#include "pose_graph_files.h"

namespace locograph {
namespace {

void compile(benchmark::State& state, const std::string& name) {
  LinearisedGraph loaded(pose_graph_file(name));
  for (auto _ : state) loaded.problem.compile(loaded.graph);
}

void linearise(benchmark::State& state, const std::string& name) {
  LinearisedGraph loaded(pose_graph_file(name));
  for (auto _ : state) benchmark::DoNotOptimize(loaded.workspace.linearise());
  state.counters["ns_per_edge"] = benchmark::Counter(
      1e-9 * loaded.problem.edge_count(),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void evaluate(benchmark::State& state, const std::string& name) {
  LinearisedGraph loaded(pose_graph_file(name));
  for (auto _ : state) {
    benchmark::DoNotOptimize(loaded.workspace.evaluate(loaded.workspace.state()));
  }
  state.counters["ns_per_edge"] = benchmark::Counter(
      1e-9 * loaded.problem.edge_count(),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void analyse(benchmark::State& state, const std::string& name) {
  LinearisedGraph loaded(pose_graph_file(name));
  for (auto _ : state) make_linear_solver("block-cholesky")->analyse(loaded.problem.pattern());
}

void factorise(benchmark::State& state, const std::string& name) {
  LinearisedGraph loaded(pose_graph_file(name));
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("block-cholesky");
  solver->analyse(loaded.problem.pattern());
  for (auto _ : state) {
    if (!solver->factorise(loaded.workspace.hessian().data(), loaded.damping.data())) {
      state.SkipWithError("not positive definite");
    }
  }
}

void solve(benchmark::State& state, const std::string& name) {
  LinearisedGraph loaded(pose_graph_file(name));
  const std::unique_ptr<LinearSolver> solver = make_linear_solver("block-cholesky");
  solver->analyse(loaded.problem.pattern());
  solver->factorise(loaded.workspace.hessian().data(), loaded.damping.data());
  for (auto _ : state) {
    solver->solve(loaded.workspace.gradient().data(), loaded.workspace.step().data());
  }
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  using Function = void (*)(benchmark::State&, const std::string&);
  const std::pair<const char*, Function> steps[] = {
      {"compile", locograph::compile},     {"linearise", locograph::linearise},
      {"evaluate", locograph::evaluate},   {"analyse", locograph::analyse},
      {"factorise", locograph::factorise}, {"solve", locograph::solve}};
  for (const auto& [step, function] : steps) {
    for (const char* name : {"intel", "manhattan", "parking-garage", "sphere2500", "torus3D"}) {
      if (!std::filesystem::exists(locograph::pose_graph_file(name))) continue;
      const std::string label = std::string(step) + "/" + name;
      benchmark::RegisterBenchmark(label.c_str(), function, std::string(name))
          ->Unit(benchmark::kMillisecond);
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
