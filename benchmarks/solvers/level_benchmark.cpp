/// The same factorisations with the kernels of each level of vector instructions that this machine
/// has (solvers/kernels.h): pose graphs, trajectories and a small bundle adjustment.
///
///     level_benchmark [--runs N] [FILE.g2o…]        # default: the shared data
///
/// Levels take turns, each in a process of its own, for a process has one level only. Prints one
/// JSON object: milliseconds of processor time of factorise() and solve(), the least of the runs,
/// so that other work on the machine counts as little as it can.

#include <locograph/common/error.h>
#include <locograph/common/simd_level.h>
#include <locograph/solvers/banded_solver.h>
#include <locograph/solvers/block_cholesky.h>
#include <locograph/solvers/kernels.h>
#include <locograph/solvers/schur_solver.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "command_line.h"
#include "linearised_graph.h"
#include "pose_graph_files.h"
#include "solvers/random_system.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

struct Times {
  double factorise = 1e300, solve = 1e300;  ///< [ms]
};

struct System {
  std::string name;
  std::function<std::unique_ptr<LinearSolver>()> solver;
  const BlockPattern* pattern;
  const double *values, *damping, *right_hand_side;
};

double processor_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Milliseconds of a call, of which one in twenty takes less, in a fifth of a second of them: the
/// least would be a slip of the clock now and then.
double quick(const std::function<void()>& work) {
  constexpr double kBudget = 0.2, kAtOnce = 1e-3;
  work();
  const double begin = processor_seconds();
  work();
  const int repeats = 1 + static_cast<int>(kAtOnce / (processor_seconds() - begin + 1e-6));
  std::vector<double> times;
  do {
    const double from = processor_seconds();
    for (int r = 0; r < repeats; ++r) work();
    times.push_back(1e3 * (processor_seconds() - from) / repeats);
  } while (processor_seconds() - begin < kBudget);
  const auto twentieth = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 20);
  std::nth_element(times.begin(), twentieth, times.end());
  return *twentieth;
}

Times measure(const System& system) {
  const std::unique_ptr<LinearSolver> solver = system.solver();
  solver->analyse(*system.pattern);
  std::vector<double> x(system.pattern->scalar_size());
  Times times;
  times.factorise = quick([&] {
    if (!solver->factorise(system.values, system.damping)) std::abort();
  });
  times.solve = quick([&] { solver->solve(system.right_hand_side, x.data()); });
  return times;
}

/// measure() in a child that has chosen this level.
Times measure_at(const std::string& level, const System& system) {
  int ends[2];
  if (pipe(ends) != 0) throw Error("no pipe to a child process");
  const pid_t child = fork();
  if (child < 0) throw Error("no child process");
  if (child == 0) {
    setenv("LOCOGRAPH_SIMD", level.c_str(), 1);
    const Times times = measure(system);
    _exit(write(ends[1], &times, sizeof times) == sizeof times ? 0 : 1);
  }
  close(ends[1]);
  Times times;
  const bool whole = read(ends[0], &times, sizeof times) == sizeof times;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!whole || status != 0) throw Error("the child process for " + system.name + " failed");
  return times;
}

/// Cameras in a row, each point seen by six that are next to each other.
test::RandomSystem random_bundle(int cameras, int points) {
  std::vector<int> dimension(cameras, 9);
  dimension.resize(cameras + points, 3);
  test::Pairs pairs;
  for (int p = 0; p < points; ++p) {
    for (int i = 0; i < 6; ++i) pairs.emplace_back(p % (cameras - 5) + i, cameras + p);
  }
  test::RandomSystem system(pairs, dimension, 1);
  system.pattern.kept = cameras;
  return system;
}

Json compare(const System& system, int runs) {
  std::map<std::string, Times> best;
  for (int run = 0; run < runs; ++run) {
    for (const std::string& level : simd_levels()) {
      const Times times = measure_at(level, system);
      best[level].factorise = std::min(best[level].factorise, times.factorise);
      best[level].solve = std::min(best[level].solve, times.solve);
    }
  }
  Json json = {{"system", system.name}};
  for (const auto& [level, times] : best) {
    json[level] = {{"factorise", times.factorise}, {"solve", times.solve}};
  }
  return json;
}

Json compare_all(const std::vector<std::filesystem::path>& files, int runs) {
  Json all = {{"unit", "ms"}, {"runs", runs}, {"levels", simd_levels()}};
  const auto add = [&](const std::string& name, auto solver, const BlockPattern& pattern,
                       const double* values, const double* damping, const double* right) {
    std::cerr << name << "\n";
    all["systems"].push_back(compare({name, solver, &pattern, values, damping, right}, runs));
  };
  const auto add_random = [&](const std::string& name, auto solver,
                              const test::RandomSystem& system) {
    add(name, solver, system.pattern, system.values.data(), system.damping.data(),
        system.right_hand_side.data());
  };
  for (const std::filesystem::path& file : files) {
    LinearisedGraph graph(file);
    add(
        file.stem().string(), [] { return std::make_unique<BlockCholesky>(); },
        graph.problem.pattern(), graph.workspace.hessian().data(), graph.damping.data(),
        graph.workspace.gradient().data());
  }
  for (const auto& [dimension, band] : {std::pair(24, 1), {24, 2}, {30, 1}, {30, 2}}) {
    add_random(
        "20 × " + std::to_string(dimension) + ", " + std::to_string(band),
        [] { return std::make_unique<BandedSolver>(); },
        test::RandomSystem(test::chain_pairs(20, band), std::vector<int>(20, dimension), 1));
  }
  add_random(
      "30 cameras, 600 points", [] { return std::make_unique<SchurSolver>(); },
      random_bundle(30, 600));
  return all;
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  using namespace locograph;
  int runs = 5;
  std::vector<std::filesystem::path> files = pose_graph_files();
  OptionParser app("Factorisations at each level of vector instructions", "level_benchmark");
  app.add_option("FILE", files, "Pose graphs (.g2o); default: the shared data");
  app.add_option("--runs", runs, "Measurements of each").positive();
  return run_benchmark(app, argc, argv,
                       [&] { std::cout << compare_all(files, runs).dump(1) << "\n"; });
}
