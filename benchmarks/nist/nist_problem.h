#pragma once
/// NIST StRD: nonlinear regression with certified answers, each from two starting points.
///
///     NistProblem problem = read_nist("Misra1a.dat");
///     NistSolution found = solve_nist(problem, 0, nist_options());
///     double digits = problem.correct_digits(found.parameters);
///
/// https://www.itl.nist.gov/div898/strd/nls/nls_main.shtml. One edge for each observation, one
/// vertex for all parameters, derivatives by dual numbers.

#include <locograph/core/optimiser.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace locograph {

struct NistObservation {
  double y = 0.0;
  std::array<double, 2> x{};
};

struct NistProblem {
  std::string name;
  std::vector<NistObservation> observations;
  std::array<std::vector<double>, 2> starts;
  std::vector<double> certified;

  /// Of the parameter that has fewest: −log₁₀ |b − certified| / |certified|, between 0 and the 11
  /// digits that are certified.
  double correct_digits(const std::vector<double>& parameters) const;
};

/// Reads the lines that the file's own header names. Throws Error with file and line.
NistProblem read_nist(const std::filesystem::path& file);

struct NistSolution {
  std::vector<double> parameters;
  OptimiserResult result;
};

/// The options used for all problems and starts alike: damping in proportion to the diagonal,
/// because parameters differ by up to ten orders of magnitude; much of it at first, because some
/// starts are so far off that a Gauss-Newton step from them leaps over the valley (any λ from 200
/// to 10⁶ solves the same problems); no convergence criterion before the digits are exhausted.
OptimiserOptions nist_options();

/// start: 0 or 1.
NistSolution solve_nist(const NistProblem& problem, int start, const OptimiserOptions& options);

}  // namespace locograph
