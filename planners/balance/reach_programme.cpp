#include <locograph/planners/balance/reach_programme.h>

#include <cmath>

namespace locograph {
namespace {

/// Of the way to what is asked.
constexpr double kReached = 1.0 - 1e-7;
constexpr double kSmallest = 1e-12;

}  // namespace

ReachProgramme::ReachProgramme(const Eigen::MatrixXd& columns, const Eigen::VectorXd& within,
                               const Eigen::VectorXd& inside, const Bounds& bounds)
    : middle_(columns * inside), way_(static_cast<int>(columns.cols())) {
  const auto rows = static_cast<int>(columns.rows());
  LinearColumns unknowns;
  for (int i = 0; i < way_; ++i) {
    for (int r = 0; r < rows; ++r) unknowns.put(r, columns(r, i));
    const auto force = static_cast<std::size_t>(i);
    const int group = bounds.group[force];
    if (bounds.most[static_cast<std::size_t>(group)] >= 0.0) unknowns.put(rows + group, 1.0);
    unknowns.end(bounds.lower[force], bounds.upper[force]);
  }
  // The way t, whose entries change.
  for (int r = 0; r < rows; ++r) unknowns.put(r, 1.0);
  unknowns.end(0.0, 1.0, -1.0);
  std::vector<double> row_lower, row_upper;
  for (int r = 0; r < rows; ++r) {
    row_lower.push_back(middle_[r] - within[r]);
    row_upper.push_back(middle_[r] + within[r]);
  }
  for (std::size_t group = 0; group < bounds.most.size(); ++group) {
    const double least = bounds.least[group], most = bounds.most[group];
    row_lower.push_back(least > 0.0 ? least : -kNoBound);
    row_upper.push_back(most >= 0.0 ? most : kNoBound);
  }
  programme_.load(unknowns, row_lower, row_upper);
}

std::optional<Eigen::VectorXd> ReachProgramme::halfspace_before(const Eigen::VectorXd& target) {
  double* entries = programme_.entries(way_).data();
  for (Eigen::Index r = 0; r < middle_.size(); ++r) {
    const double entry = middle_[r] - target[r];
    entries[r] = std::abs(entry) > kSmallest ? entry : kSmallest;  // never 0
  }
  LinearAnswer answer = programme_.primal();
  if (answer != LinearAnswer::kOptimal) answer = programme_.dual();
  if (answer != LinearAnswer::kOptimal ||
      programme_.solution()[static_cast<std::size_t>(way_)] >= kReached) {
    return std::nullopt;
  }
  Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(programme_.prices().data(), middle_.size());
  const double length = y.norm();
  if (!(length > 0.0)) return std::nullopt;
  return y / length;
}

}  // namespace locograph
