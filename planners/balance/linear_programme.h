#pragma once
/// A linear programme of some tens of rows and columns: the least cost . x with x and A x within
/// bounds.
///
///     LinearProgramme programme;                 // the most of x + y, each at most 2 ...
///     programme.resize(1, 2);
///     for (const int column : {0, 1}) {
///       programme.matrix()(0, column) = 1.0 + column;
///       programme.bound_column(column, 0.0, 2.0);
///       programme.cost()[column] = -1.0;
///     }
///     programme.bound_row(0, -kNoBound, 3.0);    // ... and x + 2 y at most 3
///     if (programme.solve() == LinearAnswer::kOptimal) std::cout << programme.solution() << '\n';
///
/// The simplex algorithm with bounded variables on a dense dictionary, first dual, then primal, so
/// that it starts from any corner (Chvátal, Linear Programming, ch. 3, 8 and 10; ratio tests of
/// Harris 1973). Numbers are taken as they are: rows and columns should be of the order of one.
/// Feasible and optimal to 1e-9, checked by the matrix that was given. Allocates only where it
/// grows. Thread-safety: one thread at a time.

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace locograph {

inline constexpr double kNoBound = std::numeric_limits<double>::infinity();

enum class LinearAnswer {
  kOptimal,
  kInfeasible,
  kUnsolved,  ///< unbounded, or a numerical failure
};

class LinearProgramme {
 public:
  /// All zero: columns from 0 up, rows without bounds, no costs. The last corner is where the next
  /// solve() starts, if it is as large.
  void resize(int rows, int columns);

  Eigen::MatrixXd& matrix();  ///< rows x columns
  Eigen::VectorXd& cost() { return cost_; }
  void bound_column(int column, double lower, double upper);
  void bound_row(int row, double lower, double upper);

  /// From the last corner; at first from where all rows are free.
  LinearAnswer solve();
  /// Of the last solve(), where it is optimal.
  double value() const { return cost_.dot(solution_); }
  const Eigen::VectorXd& solution() const { return solution_; }
  const Eigen::VectorXd& prices() const { return prices_; }  ///< of rows: d value / d bound

 private:
  /// Variables: the columns, then the rows. Those that are not basic are at one of their bounds.
  void start_afresh();
  void build();
  void evaluate();
  void find_slopes();
  double rest_at(int variable) const;
  bool feasible() const;
  bool make_dual_feasible();
  LinearAnswer run();
  LinearAnswer dual();
  LinearAnswer primal();
  void pivot(int row, int place);
  void exchange(int row, int place, double step, double bound);
  bool verified();

  int rows_ = 0, columns_ = 0;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd cost_, lower_, upper_;  ///< bounds: of all variables
  std::vector<int> basic_, free_;         ///< variables: by row, by column of the dictionary
  std::vector<bool> is_basic_, at_upper_;
  bool built_ = false;
  Eigen::MatrixXd dictionary_;                        ///< basic = dictionary free
  Eigen::VectorXd basic_value_, free_value_, slope_;  ///< slope: d cost / d free
  Eigen::VectorXd column_, row_;
  Eigen::VectorXd solution_, prices_;
};

}  // namespace locograph
