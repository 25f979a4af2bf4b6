#include <locograph/check/dense_programme.h>

#include <ClpMessage.hpp>
#include <ClpSimplex.hpp>
#include <CoinMessage.hpp>
#include <limits>
#include <vector>

namespace locograph {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

/// Clp's word for no bound is the largest number.
Eigen::VectorXd bounds_for_clp(const Eigen::VectorXd& bounds) {
  return bounds.cwiseMax(-COIN_DBL_MAX).cwiseMin(COIN_DBL_MAX);
}

/// The texts of messages, which Clp reads even where it prints none: copying them takes a fraction
/// of the time in which it makes them.
void give_messages(ClpSimplex& model) {
  static const ClpMessage of_clp;
  static const CoinMessage of_coin;
  *model.messagesPointer() = of_clp;
  *model.coinMessagesPointer() = of_coin;
}

}  // namespace

DenseProgramme::DenseProgramme(Eigen::Index rows, Eigen::Index columns)
    : matrix(Eigen::MatrixXd::Zero(rows, columns)),
      objective(Eigen::VectorXd::Zero(columns)),
      least(Eigen::VectorXd::Zero(columns)),
      most(Eigen::VectorXd::Constant(columns, kNoBound)),
      lower(Eigen::VectorXd::Constant(rows, -kNoBound)),
      upper(Eigen::VectorXd::Constant(rows, kNoBound)) {}

std::optional<DenseSolution> solve(const DenseProgramme& programme) {
  const Eigen::MatrixXd& matrix = programme.matrix;
  const int rows = static_cast<int>(matrix.rows()), columns = static_cast<int>(matrix.cols());
  std::vector<int> starts = {0}, indices;
  std::vector<double> values;
  for (int c = 0; c < columns; ++c) {
    for (int r = 0; r < rows; ++r) {
      if (matrix(r, c) == 0.0) continue;
      indices.push_back(r);
      values.push_back(matrix(r, c));
    }
    starts.push_back(static_cast<int>(indices.size()));
  }
  ClpSimplex model(true);
  give_messages(model);
  model.setLogLevel(0);
  model.scaling(0);
  model.setPrimalTolerance(1e-9);
  model.setDualTolerance(1e-9);
  const Eigen::VectorXd least = bounds_for_clp(programme.least),
                        most = bounds_for_clp(programme.most),
                        lower = bounds_for_clp(programme.lower),
                        upper = bounds_for_clp(programme.upper);
  model.loadProblem(columns, rows, starts.data(), indices.data(), values.data(), least.data(),
                    most.data(), programme.objective.data(), lower.data(), upper.data());
  model.dual();
  if (model.status() > 1) model.primal();
  if (model.status() != 0) return std::nullopt;
  return DenseSolution{Eigen::Map<const Eigen::VectorXd>(model.primalColumnSolution(), columns),
                       Eigen::Map<const Eigen::VectorXd>(model.dualRowSolution(), rows)};
}

}  // namespace locograph
