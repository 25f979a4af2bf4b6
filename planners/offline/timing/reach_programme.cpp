#include <locograph/planners/offline/timing/reach_programme.h>

#include <ClpSimplex.hpp>
#include <cmath>
#include <limits>

namespace locograph {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::max();
/// Of the way to what is asked.
constexpr double kReached = 1.0 - 1e-7;
constexpr double kSmallest = 1e-12;

}  // namespace

struct ReachProgramme::Model {
  ClpSimplex simplex;
};

ReachProgramme::ReachProgramme(const Eigen::MatrixXd& columns, const Eigen::VectorXd& within,
                               const Eigen::VectorXd& inside, const Bounds& bounds)
    : model_(std::make_unique<Model>()), middle_(columns * inside) {
  const auto rows = static_cast<int>(columns.rows()), forces = static_cast<int>(columns.cols());
  const auto groups = static_cast<int>(bounds.most.size());
  std::vector<CoinBigIndex> starts = {0};
  std::vector<int> indices;
  std::vector<double> elements;
  const auto put = [&](int row, double value) {
    indices.push_back(row);
    elements.push_back(value);
  };
  for (int i = 0; i < forces; ++i) {
    for (int r = 0; r < rows; ++r) {
      if (columns(r, i) != 0.0) put(r, columns(r, i));
    }
    const int group = bounds.group[static_cast<std::size_t>(i)];
    if (bounds.most[static_cast<std::size_t>(group)] >= 0.0) put(rows + group, 1.0);
    starts.push_back(static_cast<CoinBigIndex>(indices.size()));
  }
  // The way t, whose entries change.
  for (int r = 0; r < rows; ++r) put(r, 1.0);
  starts.push_back(static_cast<CoinBigIndex>(indices.size()));
  std::vector<double> lower = bounds.lower, upper = bounds.upper;
  lower.push_back(0.0);
  upper.push_back(1.0);
  std::vector<double> costs(lower.size(), 0.0), row_lower, row_upper;
  costs.back() = -1.0;
  for (int r = 0; r < rows; ++r) {
    row_lower.push_back(middle_[r] - within[r]);
    row_upper.push_back(middle_[r] + within[r]);
  }
  for (const double most : bounds.most) {
    row_lower.push_back(-kUnbounded);
    row_upper.push_back(most >= 0.0 ? most : kUnbounded);
  }
  ClpSimplex& simplex = model_->simplex;
  simplex.setLogLevel(0);
  simplex.scaling(0);            // all is of the order of one
  simplex.setPerturbation(102);  // none
  simplex.setPrimalTolerance(1e-9);
  simplex.setDualTolerance(1e-9);
  simplex.loadProblem(forces + 1, rows + groups, starts.data(), indices.data(), elements.data(),
                      lower.data(), upper.data(), costs.data(), row_lower.data(), row_upper.data());
}

ReachProgramme::~ReachProgramme() = default;

std::optional<Eigen::VectorXd> ReachProgramme::halfspace_before(const Eigen::VectorXd& target) {
  ClpSimplex& simplex = model_->simplex;
  const int way = simplex.numberColumns() - 1;
  const Eigen::Index rows = middle_.size();
  double* entries =
      simplex.matrix()->getMutableElements() + simplex.matrix()->getVectorStarts()[way];
  for (Eigen::Index r = 0; r < rows; ++r) {
    // Never 0: Clp was told of as many entries.
    const double entry = middle_[r] - target[r];
    entries[r] = std::abs(entry) > kSmallest ? entry : kSmallest;
  }
  simplex.primal();  // from the last corner
  if (!simplex.isProvenOptimal()) {
    simplex.allSlackBasis(true);
    simplex.dual();
  }
  if (!simplex.isProvenOptimal() || simplex.primalColumnSolution()[way] >= kReached) {
    return std::nullopt;
  }
  Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(simplex.dualRowSolution(), rows);
  const double length = y.norm();
  if (!(length > 0.0)) return std::nullopt;
  return y / length;
}

}  // namespace locograph
