#pragma once
/// A linear programme with few rows, written as a matrix, solved by Clp.
///
///     DenseProgramme programme(6, 20);
///     programme.objective[0] = 1.0;
///     programme.matrix.col(0).setOnes();
///     programme.lower.setConstant(0.5);
///     const std::optional<DenseSolution> solution = solve(programme);   // x_0 = 0.5
///
/// The least objective . x with least <= x <= most and lower <= matrix x <= upper. Rows and columns
/// are to be dimensionless and of the order of one: they are not scaled. Nothing where no x fulfils
/// that, or where Clp fails.

#include <Eigen/Core>
#include <optional>

namespace locograph {

struct DenseProgramme {
  /// Columns from 0 up, rows without bounds, nothing to be sought.
  DenseProgramme(Eigen::Index rows, Eigen::Index columns);

  Eigen::MatrixXd matrix;
  Eigen::VectorXd objective, least, most;  ///< of columns; infinite: without a bound
  Eigen::VectorXd lower, upper;            ///< of rows
};

struct DenseSolution {
  Eigen::VectorXd x;
  Eigen::VectorXd prices;  ///< of rows: the dual solution
};

std::optional<DenseSolution> solve(const DenseProgramme& programme);

}  // namespace locograph
