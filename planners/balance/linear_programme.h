#pragma once
/// A linear programme, solved by the simplex algorithm: the least cost . x with x and A x within
/// bounds.
///
///     LinearColumns columns;                       // the most of x + y, each at most 2 ...
///     for (const int row : {0, 1}) {
///       columns.put(row, 1.0);
///       columns.put(2, row == 0 ? 1.0 : 2.0);      // ... and x + 2 y at most 3
///       columns.end(0.0, kNoBound, -1.0);
///     }
///     LinearProgramme programme(LinearProgramme::Perturbation::kNone);
///     programme.load(columns, {-kNoBound, -kNoBound, -kNoBound}, {2.0, 2.0, 3.0});
///     if (programme.dual() == LinearAnswer::kOptimal) std::cout << programme.solution()[0] <<
///     '\n';
///
/// Numbers are taken as they are: rows and columns should be of the order of one. Feasible and
/// optimal to 1e-9. Thread-safety: one thread at a time.

#include <limits>
#include <memory>
#include <span>
#include <vector>

class ClpSimplex;

namespace locograph {

inline constexpr double kNoBound = std::numeric_limits<double>::max();

/// The unknowns, one after another.
class LinearColumns {
 public:
  /// An entry of the column that is not ended yet; 0 is left out.
  void put(int row, double value);
  void end(double lower, double upper, double cost = 0.0);

 private:
  friend class LinearProgramme;
  std::vector<int> starts_ = {0}, rows_;
  std::vector<double> entries_, lower_, upper_, costs_;
};

enum class LinearAnswer {
  kOptimal,
  kInfeasible,
  kUnsolved,  ///< unbounded, or a numerical failure
};

class LinearProgramme {
 public:
  /// Whether bounds are moved a little while they are degenerate.
  enum class Perturbation { kNone, kAutomatic };

  explicit LinearProgramme(Perturbation perturbation);
  ~LinearProgramme();
  LinearProgramme(LinearProgramme&&) noexcept;

  /// The bounds are those of A x, row by row.
  void load(const LinearColumns& columns, const std::vector<double>& lower,
            const std::vector<double>& upper);
  void set_cost(int column, double cost);
  /// Those of a column that put() was given, in its order. They may change, but not become 0.
  std::span<double> entries(int column);

  LinearAnswer primal();  ///< from the last corner
  LinearAnswer dual();    ///< from the corner where all rows are free
  /// From the corner that was the best one of the programme before, if that was as large.
  LinearAnswer dual_from_before();
  /// Of the last run.
  double value() const;
  std::span<const double> solution() const;  ///< of each column
  std::span<const double> prices() const;    ///< of each row: what the cost gains with its bound

 private:
  std::unique_ptr<ClpSimplex> simplex_;
  std::vector<unsigned char> corner_;  ///< of the programme before; empty: none
};

}  // namespace locograph
