#pragma once
/// When a conjugate-gradient solve ends.
///
///     PcgOptions options;
///     options.relative_tolerance = 1e-2;        // inexact steps, for very large problems
///     PcgSolver solver(options);

namespace locograph {

struct PcgOptions {
  /// Ends when √(rᵀM⁻¹r) is below this fraction of its value for x = 0, M the preconditioner. In
  /// (0, 1). The norm does not depend on the units of the unknowns.
  double relative_tolerance = 1e-8;
  /// Ends after so many products with the matrix; the best it has is the solution then.
  int max_iterations = 1000;

  /// Throws Error naming the option that is out of range.
  void validate() const;
};

}  // namespace locograph
