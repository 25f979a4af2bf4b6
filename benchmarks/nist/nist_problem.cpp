#include "nist_problem.h"

#include <locograph/solvers/linear_solvers.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "nist_edge.h"

namespace locograph {
namespace {

/// The numbers of "… (lines A to B)" on the line of the header that has `title`.
std::pair<int, int> line_range(const std::vector<std::string>& lines, const std::string& title,
                               const std::string& file) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::size_t at = lines[i].find(title), open = lines[i].find("(lines ");
    if (at == std::string::npos || open == std::string::npos) continue;
    std::istringstream in(lines[i].substr(open + 7));
    int first = 0, last = 0;
    std::string to;
    if (in >> first >> to >> last && first >= 1 && first <= last &&
        last <= static_cast<int>(lines.size())) {
      return {first, last};
    }
    throw Error(file, static_cast<int>(i) + 1, "no range of lines of the file", "(lines A to B)");
  }
  throw Error(file, 0, "no line that says where '" + title + "' is", "an StRD header");
}

}  // namespace

NistProblem read_nist(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw Error(file.string(), 0, "cannot be read", "a data set of NIST StRD");
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  NistProblem problem;
  problem.name = file.stem().string();
  const auto [first_parameter, last_parameter] =
      line_range(lines, "Starting Values", file.string());
  for (int i = first_parameter; i <= last_parameter; ++i) {
    std::istringstream fields(lines[i - 1]);
    std::string name, equals;
    double first = 0.0, second = 0.0, certified = 0.0;
    if (!(fields >> name >> equals >> first >> second >> certified)) {
      throw Error(file.string(), i, "no parameter", "b1 = START1 START2 CERTIFIED");
    }
    problem.starts[0].push_back(first);
    problem.starts[1].push_back(second);
    problem.certified.push_back(certified);
  }
  const std::size_t predictors = problem.name == "Nelson" ? 2 : 1;
  const auto [first_row, last_row] = line_range(lines, " Data  ", file.string());
  for (int i = first_row; i <= last_row; ++i) {
    std::istringstream fields(lines[i - 1]);
    NistObservation observation;
    fields >> observation.y;
    for (std::size_t p = 0; p < predictors; ++p) fields >> observation.x[p];
    if (!fields) throw Error(file.string(), i, "no observation", "y x");
    problem.observations.push_back(observation);
  }
  return problem;
}

double NistProblem::correct_digits(const std::vector<double>& parameters) const {
  double fewest = 11.0;
  for (std::size_t i = 0; i < certified.size(); ++i) {
    const double off = std::abs(parameters[i] - certified[i]) / std::abs(certified[i]);
    fewest = std::min(fewest, std::isfinite(off) ? std::max(-std::log10(off), 0.0) : 0.0);
  }
  return fewest;
}

NistModel nist_model(const std::string& name) {
  static const std::map<std::string, NistModel> models = {
      {"Bennett5", NistModel::kBennett5}, {"BoxBOD", NistModel::kBoxBod},
      {"Chwirut1", NistModel::kChwirut},  {"Chwirut2", NistModel::kChwirut},
      {"DanWood", NistModel::kDanWood},   {"Eckerle4", NistModel::kEckerle4},
      {"ENSO", NistModel::kEnso},         {"Gauss1", NistModel::kGauss},
      {"Gauss2", NistModel::kGauss},      {"Gauss3", NistModel::kGauss},
      {"Hahn1", NistModel::kHahn1},       {"Thurber", NistModel::kHahn1},
      {"Kirby2", NistModel::kKirby2},     {"Lanczos1", NistModel::kLanczos},
      {"Lanczos2", NistModel::kLanczos},  {"Lanczos3", NistModel::kLanczos},
      {"MGH09", NistModel::kMgh09},       {"MGH10", NistModel::kMgh10},
      {"MGH17", NistModel::kMgh17},       {"Misra1a", NistModel::kBoxBod},
      {"Misra1b", NistModel::kMisra1b},   {"Misra1c", NistModel::kMisra1c},
      {"Misra1d", NistModel::kMisra1d},   {"Nelson", NistModel::kNelson},
      {"Rat42", NistModel::kRat42},       {"Rat43", NistModel::kRat43},
      {"Roszman1", NistModel::kRoszman1}};
  const auto found = models.find(name);
  if (found == models.end()) throw Error("unknown data set '" + name + "'", "one of NIST StRD");
  return found->second;
}

OptimiserOptions nist_options() {
  OptimiserOptions options;
  options.max_iterations = 10000;
  options.scale_by_diagonal = true;
  options.initial_lambda = 1e4;
  options.gain = 0.0;
  options.gradient_tolerance = 0.0;
  options.step_tolerance = 1e-15;
  return options;
}

NistSolution solve_nist(const NistProblem& problem, int start, const OptimiserOptions& options) {
  NistSolution solution;
  const NistModel model = nist_model(problem.name);
  with_parameter_count(static_cast<int>(problem.certified.size()),
                       [&]<int N>(std::integral_constant<int, N>) {
                         Graph graph;
                         VertexNist<N> vertex;
                         for (int i = 0; i < N; ++i) vertex.state[i] = problem.starts[start][i];
                         const VertexId<VertexNist<N>> parameters = graph.add_vertex(0, vertex);
                         for (const NistObservation& observation : problem.observations) {
                           EdgeNist<N> edge;
                           edge.model = model;
                           edge.predictors = observation.x;
                           edge.response = nist_response(model, observation.y);
                           graph.add_edge(edge, parameters);
                         }
                         solution.result = optimise(graph, options, *make_linear_solver("dense"));
                         const auto& state = graph.vertex(parameters).state;
                         solution.parameters.assign(state.data(), state.data() + N);
                       });
  return solution;
}

}  // namespace locograph
