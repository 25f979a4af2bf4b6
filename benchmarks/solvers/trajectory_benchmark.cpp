/// Factorisation and solution of trajectory-shaped systems: a few wide blocks in a narrow band, as
/// a planner's horizon has them. Ours (the banded solver), CHOLMOD and Eigen in the same run.
///
///     trajectory_benchmark [--runs N]
///
/// Prints one JSON object: medians in milliseconds of factorise() and solve() together, and how
/// many times longer the others take.

#include <locograph/common/deadline.h>
#include <locograph/common/error.h>
#include <locograph/solvers/banded_solver.h>
#include <locograph/solvers/block_cholesky.h>
#include <locograph/solvers/eigen_solver.h>
#include <locograph/solvers/linear_solvers.h>
#if LOCOGRAPH_HAVE_CHOLMOD
#include <locograph/solvers/cholmod_solver.h>
#endif

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "command_line.h"
#include "solvers/random_system.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

struct Contestant {
  std::string name;
  std::unique_ptr<LinearSolver> solver;
  std::vector<double> factorise, solve, both;
};

double median(std::vector<double>& values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

Json compare(int vertices, int dimension, int band, int runs) {
  const test::RandomSystem system(test::chain_pairs(vertices, band),
                                  std::vector<int>(vertices, dimension), 1);
  std::vector<Contestant> all;
  all.push_back({"banded", std::make_unique<BandedSolver>(), {}, {}, {}});
  all.push_back({"block_cholesky", std::make_unique<BlockCholesky>(), {}, {}, {}});
#if LOCOGRAPH_HAVE_CHOLMOD
  using Mode = CholmodSolver::Mode;
  all.push_back(
      {"cholmod_simplicial", std::make_unique<CholmodSolver>(Mode::simplicial), {}, {}, {}});
  all.push_back(
      {"cholmod_supernodal", std::make_unique<CholmodSolver>(Mode::supernodal), {}, {}, {}});
#endif
  all.push_back({"eigen", std::make_unique<EigenSolver>(), {}, {}, {}});
  for (Contestant& c : all) c.solver->analyse(system.pattern);
  std::vector<double> x(system.right_hand_side.size());
  // By turns, so that all see the same state of the machine.
  for (int run = 0; run < runs; ++run) {
    for (Contestant& c : all) {
      const Stopwatch watch;
      if (!c.solver->factorise(system.values.data(), system.damping.data())) {
        throw Error("a factorisation failed", "a positive definite matrix");
      }
      c.factorise.push_back(1e3 * watch.seconds());
      c.solver->solve(system.right_hand_side.data(), x.data());
      c.both.push_back(1e3 * watch.seconds());
      c.solve.push_back(c.both.back() - c.factorise.back());
    }
  }
  const std::unique_ptr<LinearSolver> chosen = make_linear_solver("auto");
  chosen->analyse(system.pattern);
  Json json = {{"vertices", vertices}, {"dimension", dimension}, {"band", band}};
  json["auto"] = chosen->name();
  const double ours = median(all.front().both);
  for (Contestant& c : all) {
    json[c.name] = {{"factorise", median(c.factorise)},
                    {"solve", median(c.solve)},
                    {"both", median(c.both)},
                    {"over_banded", median(c.both) / ours}};
  }
#if LOCOGRAPH_HAVE_CHOLMOD
  json["best_cholmod_over_banded"] =
      std::min(json["cholmod_simplicial"]["over_banded"].get<double>(),
               json["cholmod_supernodal"]["over_banded"].get<double>());
#endif
  return json;
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  using namespace locograph;
  int runs = 501;
  OptionParser app("Factorisations of trajectories", "trajectory_benchmark");
  app.add_option("--runs", runs, "Measurements of each").positive();
  return run_benchmark(app, argc, argv, [&] {
    Json all = {{"unit", "ms"}, {"runs", runs}};
    all["trajectories"] = Json::array();
    for (const auto& [dimension, band] : {std::pair(24, 1), {24, 2}, {30, 1}, {30, 2}}) {
      all["trajectories"].push_back(compare(20, dimension, band, runs));
    }
    std::cout << all.dump(1) << "\n";
  });
}
