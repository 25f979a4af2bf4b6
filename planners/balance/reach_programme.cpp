#include <locograph/planners/balance/reach_programme.h>

#include <cmath>

namespace locograph {
namespace {

/// Of the way to what is asked.
constexpr double kReached = 1.0 - 1e-7;

}  // namespace

ReachProgramme::ReachProgramme(const Eigen::MatrixXd& columns, const Eigen::VectorXd& within,
                               const Eigen::VectorXd& inside, const Bounds& bounds)
    : middle_(columns * inside), way_(static_cast<int>(columns.cols())) {
  const auto rows = static_cast<int>(columns.rows());
  const auto groups = static_cast<int>(bounds.most.size());
  programme_.resize(rows + groups, way_ + 1);
  programme_.matrix().topLeftCorner(rows, way_) = columns;
  for (int i = 0; i < way_; ++i) {
    const auto force = static_cast<std::size_t>(i);
    const int group = bounds.group[force];
    if (bounds.most[static_cast<std::size_t>(group)] >= 0.0) {
      programme_.matrix()(rows + group, i) = 1.0;
    }
    programme_.bound_column(i, bounds.lower[force], bounds.upper[force]);
  }
  programme_.bound_column(way_, 0.0, 1.0);
  programme_.cost()[way_] = -1.0;
  for (int r = 0; r < rows; ++r) {
    programme_.bound_row(r, middle_[r] - within[r], middle_[r] + within[r]);
  }
  for (int group = 0; group < groups; ++group) {
    const double least = bounds.least[static_cast<std::size_t>(group)];
    const double most = bounds.most[static_cast<std::size_t>(group)];
    programme_.bound_row(rows + group, least > 0.0 ? least : -kNoBound,
                         most >= 0.0 ? most : kNoBound);
  }
}

std::optional<Eigen::VectorXd> ReachProgramme::halfspace_before(const Eigen::VectorXd& target) {
  programme_.matrix().col(way_).head(middle_.size()) = middle_ - target;
  if (programme_.solve() != LinearAnswer::kOptimal || programme_.solution()[way_] >= kReached) {
    return std::nullopt;
  }
  const Eigen::VectorXd y = programme_.prices().head(middle_.size());
  const double length = y.norm();
  if (!(length > 0.0)) return std::nullopt;
  return y / length;
}

}  // namespace locograph
