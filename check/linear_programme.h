#pragma once
/// A linear programme, solved by Clp.
///
///     LinearProgramme programme(6, 20);
///     programme.objective[0] = 1.0;
///     programme.matrix.col(0).setOnes();
///     programme.lower.setConstant(0.5);
///     const std::optional<LinearSolution> solution = solve(programme);   // x_0 = 0.5
///
/// The least objective . x with least <= x <= most and lower <= matrix x <= upper. Rows and columns
/// are to be dimensionless and of the order of one: they are not scaled. Nothing where no x fulfils
/// that, or where Clp fails.

#include <Eigen/Core>
#include <optional>

namespace locograph {

struct LinearProgramme {
  /// Columns from 0 up, rows without bounds, nothing to be sought.
  LinearProgramme(Eigen::Index rows, Eigen::Index columns);

  Eigen::MatrixXd matrix;
  Eigen::VectorXd objective, least, most;  ///< of columns; infinite: without a bound
  Eigen::VectorXd lower, upper;            ///< of rows
};

struct LinearSolution {
  Eigen::VectorXd x;
  Eigen::VectorXd prices;  ///< of rows: the dual solution
};

std::optional<LinearSolution> solve(const LinearProgramme& programme);

}  // namespace locograph
