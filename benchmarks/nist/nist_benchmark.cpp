/// NIST StRD: 27 data sets, two starting points each, by locograph and by Ceres in the same run.
///
///     nist_benchmark [FOLDER]        # default: nist of the shared data
///
/// Prints one JSON object: for each problem the digits of the worst parameter that agree with the
/// certified values, iterations and reason; how many of the 54 have 4 digits or more. Every solver
/// has one set of options for all problems. Ceres runs with QR of the dense Jacobian and tolerances
/// of the machine's precision, as its own example for these data does. The table goes to standard
/// error.

#include <ceres/ceres.h>
#include <glog/logging.h>
#include <locograph/common/deadline.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "nist_edge.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

struct Outcome {
  double digits = 0.0;
  int iterations = 0;
  double seconds = 0.0;
  std::string reason;
};

Outcome by_locograph(const NistProblem& problem, int start, Algorithm algorithm) {
  OptimiserOptions options = nist_options();
  options.algorithm = algorithm;
  const Stopwatch watch;
  const NistSolution solution = solve_nist(problem, start, options);
  return {problem.correct_digits(solution.parameters), solution.result.iterations, watch.seconds(),
          solution.result.reason_text()};
}

template <int N>
struct Residual {
  EdgeNist<N> edge;
  template <class T>
  bool operator()(const T* b, T* residual) const {
    residual[0] = nist_prediction<N>(edge.model, b, edge.predictors) - edge.response;
    return true;
  }
};

Outcome by_ceres(const NistProblem& problem, int start, ceres::TrustRegionStrategyType strategy) {
  Outcome outcome;
  const NistModel model = nist_model(problem.name);
  with_parameter_count(
      static_cast<int>(problem.certified.size()), [&]<int N>(std::integral_constant<int, N>) {
        std::vector<double> parameters = problem.starts[start];
        ceres::Problem least_squares;
        for (const NistObservation& observation : problem.observations) {
          EdgeNist<N> edge;
          edge.model = model;
          edge.predictors = observation.x;
          edge.response = nist_response(model, observation.y);
          least_squares.AddResidualBlock(
              new ceres::AutoDiffCostFunction<Residual<N>, 1, N>(new Residual<N>{edge}), nullptr,
              parameters.data());
        }
        ceres::Solver::Options options;
        options.linear_solver_type = ceres::DENSE_QR;
        options.trust_region_strategy_type = strategy;
        options.max_num_iterations = 10000;
        options.function_tolerance = std::numeric_limits<double>::epsilon();
        options.gradient_tolerance = std::numeric_limits<double>::epsilon();
        options.parameter_tolerance = std::numeric_limits<double>::epsilon();
        options.logging_type = ceres::SILENT;
        ceres::Solver::Summary summary;
        const Stopwatch watch;
        ceres::Solve(options, &least_squares, &summary);
        outcome = {problem.correct_digits(parameters), summary.num_successful_steps,
                   watch.seconds(), summary.message};
      });
  return outcome;
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  using namespace locograph;
  // Steps to where a model overflows are refused; Ceres would print each of them.
  FLAGS_minloglevel = google::GLOG_FATAL;
  const std::filesystem::path folder = argc > 1
                                           ? std::filesystem::path(argv[1])
                                           : std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "nist";
  const std::pair<const char*, std::function<Outcome(const NistProblem&, int)>> solvers[] = {
      {"locograph lm",
       [](const auto& p, int s) { return by_locograph(p, s, Algorithm::kLevenbergMarquardt); }},
      {"locograph dogleg",
       [](const auto& p, int s) { return by_locograph(p, s, Algorithm::kDogleg); }},
      {"ceres lm", [](const auto& p, int s) { return by_ceres(p, s, ceres::LEVENBERG_MARQUARDT); }},
      {"ceres dogleg", [](const auto& p, int s) { return by_ceres(p, s, ceres::DOGLEG); }}};
  try {
    if (!std::filesystem::is_directory(folder)) {
      throw Error(folder.string(), 0, "is not there", "the folder of the .dat files");
    }
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ".dat") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    Json all;
    std::map<std::string, int> solved;
    std::map<std::string, double> seconds;
    std::fprintf(stderr, "%-12s", "digits");
    for (const auto& [name, solve] : solvers) std::fprintf(stderr, "%18s", name);
    std::fprintf(stderr, "\n");
    for (const std::filesystem::path& file : files) {
      const NistProblem problem = read_nist(file);
      for (int start = 0; start < 2; ++start) {
        Json json = {{"problem", problem.name}, {"start", start + 1}};
        std::fprintf(stderr, "%-10s %d", problem.name.c_str(), start + 1);
        for (const auto& [name, solve] : solvers) {
          const Outcome outcome = solve(problem, start);
          json[name] = {{"digits", outcome.digits},
                        {"iterations", outcome.iterations},
                        {"seconds", outcome.seconds},
                        {"reason", outcome.reason}};
          if (outcome.digits >= 4.0) ++solved[name];
          seconds[name] += outcome.seconds;
          std::fprintf(stderr, "%11.1f %6d", outcome.digits, outcome.iterations);
        }
        std::fprintf(stderr, "\n");
        all["problems"].push_back(json);
      }
    }
    for (const auto& [name, solve] : solvers) {
      all["solved_to_4_digits"][name] = solved[name];
      all["seconds"][name] = seconds[name];
      std::fprintf(stderr, "%s: %d of %zu\n", name, solved[name], 2 * files.size());
    }
    std::cout << all.dump(1) << "\n";
  } catch (const Error& error) {
    std::cerr << "nist_benchmark: " << error.what() << "\n";
    return 2;
  }
  return 0;
}
