#include <locograph/solvers/dense_qp.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

/// Of a row of length 1.
constexpr double kViolated = 1e-9;
/// What is left of a normal beside those of the active rows, of its length.
constexpr double kDependent = 1e-10;
constexpr int kStepsPerRow = 20;

}  // namespace

DenseQp::DenseQp(int variables, int rows)
    : hessian_(Eigen::MatrixXd::Zero(variables, variables)),
      gradient_(Eigen::VectorXd::Zero(variables)),
      rows_(decltype(rows_)::Zero(rows, variables)),
      lower_(Eigen::VectorXd::Constant(rows, -kUnbounded)),
      upper_(Eigen::VectorXd::Constant(rows, kUnbounded)),
      length_(rows),
      factor_(variables),
      x_(variables),
      multipliers_(rows),
      was_active_(static_cast<std::size_t>(rows), false),
      active_row_(static_cast<std::size_t>(variables) + 1),
      active_sign_(static_cast<std::size_t>(variables) + 1),
      is_active_(static_cast<std::size_t>(rows)),
      is_dependent_(static_cast<std::size_t>(rows)),
      j_(variables, variables),
      r_(variables, variables),
      dual_(variables + 1),
      normal_(variables),
      d_(variables),
      along_(variables),
      change_(variables + 1) {}

/// At the least of the cost alone.
bool DenseQp::begin() {
  steps_ = 0;
  active_ = 0;
  is_active_.assign(is_active_.size(), false);
  is_dependent_.assign(is_dependent_.size(), false);
  factor_.compute(hessian_);
  if (factor_.info() != Eigen::Success) return false;
  x_ = -gradient_;
  factor_.solveInPlace(x_);
  j_.setIdentity();
  factor_.matrixU().solveInPlace(j_);
  for (int i = 0; i < rows(); ++i) length_[i] = std::max(rows_.row(i).norm(), 1e-300);
  return x_.allFinite();
}

QpAnswer DenseQp::solve() {
  if (!begin()) return QpAnswer::kUnsolved;
  for (int i = 0; i < rows(); ++i) {
    if (lower_[i] != upper_[i]) continue;
    const double off = rows_.row(i).dot(x_) - lower_[i];
    const QpAnswer answer = take_in({i, off <= 0.0 ? 1.0 : -1.0});
    if (answer != QpAnswer::kOptimal) return answer;
  }
  for (Violated next = most_violated(); next.row >= 0; next = most_violated()) {
    const QpAnswer answer = take_in(next);
    if (answer != QpAnswer::kOptimal) return answer;
  }
  multipliers_.setZero();
  was_active_.assign(was_active_.size(), false);
  for (int k = 0; k < active_; ++k) {
    const auto at = static_cast<std::size_t>(k);
    multipliers_[active_row_[at]] = active_sign_[at] * dual_[k];
    was_active_[static_cast<std::size_t>(active_row_[at])] = true;
  }
  return QpAnswer::kOptimal;
}

DenseQp::Violated DenseQp::most_violated() const {
  Violated result;
  double most = kViolated;
  bool known = false;
  for (int i = 0; i < rows(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (is_active_[at] || is_dependent_[at]) continue;
    const double value = rows_.row(i).dot(x_);
    const double below = (lower_[i] - value) / length_[i];
    const double above = (value - upper_[i]) / length_[i];
    const double by = std::max(below, above);
    if (!(by > kViolated) || (known && !was_active_[at])) continue;
    if (by <= most && known == was_active_[at]) continue;
    most = by;
    known = was_active_[at];
    result = {i, below > above ? 1.0 : -1.0};
  }
  return result;
}

/// along_: where x goes, change_: where multipliers go, as the row with normal_ is taken in.
void DenseQp::find_directions() {
  d_.noalias() = j_.transpose() * normal_;
  const int left = variables() - active_;
  along_.noalias() = j_.rightCols(left) * d_.tail(left);
  change_.head(active_) = d_.head(active_);
  r_.topLeftCorner(active_, active_)
      .triangularView<Eigen::Upper>()
      .solveInPlace(change_.head(active_));
}

QpAnswer DenseQp::take_in(Violated violated) {
  const int row = violated.row;
  const double sign = violated.sign;
  const bool equality = lower_[row] == upper_[row];
  const double bound = sign > 0.0 ? lower_[row] : -upper_[row];
  normal_ = sign * rows_.row(row).transpose();
  double multiplier = 0.0;
  for (;;) {
    if (++steps_ > kStepsPerRow * (rows() + variables())) return QpAnswer::kUnsolved;
    find_directions();
    // The largest step that keeps the multipliers of active inequalities from getting negative.
    double in_dual = kUnbounded;
    int leaves = -1;
    for (int k = 0; k < active_; ++k) {
      const int other = active_row_[static_cast<std::size_t>(k)];
      if (lower_[other] == upper_[other] || !(change_[k] > 0.0)) continue;
      const double step = dual_[k] / change_[k];
      if (step >= in_dual) continue;
      in_dual = step;
      leaves = k;
    }
    const double rate = along_.dot(normal_);
    const double missing = bound - normal_.dot(x_);
    const bool dependent =
        active_ == variables() || d_.tail(variables() - active_).norm() <= kDependent * d_.norm();
    const double in_primal = dependent ? kUnbounded : std::max(0.0, missing) / rate;
    if (dependent && equality && std::abs(missing) <= kViolated * length_[row]) {
      is_dependent_[static_cast<std::size_t>(row)] = true;
      return QpAnswer::kOptimal;
    }
    const double step = std::min(in_dual, in_primal);
    if (!std::isfinite(step)) return QpAnswer::kInfeasible;
    dual_.head(active_) -= step * change_.head(active_);
    multiplier += step;
    if (!dependent) x_ += step * along_;
    if (in_primal <= in_dual) {
      if (add(row, sign, multiplier)) return QpAnswer::kOptimal;
      return QpAnswer::kUnsolved;
    }
    drop(leaves);
  }
}

/// d_ is of the row's normal.
bool DenseQp::add(int row, double sign, double multiplier) {
  // Turns the columns of J that are left so that only the first one of them sees the normal.
  for (int k = variables() - 1; k > active_; --k) {
    const double a = d_[k - 1], b = d_[k];
    if (b == 0.0) continue;
    const double length = std::hypot(a, b), c = a / length, s = b / length;
    d_[k - 1] = length;
    d_[k] = 0.0;
    along_ = j_.col(k - 1);
    j_.col(k - 1) = c * along_ + s * j_.col(k);
    j_.col(k) = c * j_.col(k) - s * along_;
  }
  if (!(std::abs(d_[active_]) > 0.0)) return false;
  r_.col(active_).head(active_ + 1) = d_.head(active_ + 1);
  const auto at = static_cast<std::size_t>(active_);
  active_row_[at] = row;
  active_sign_[at] = sign;
  dual_[active_] = multiplier;
  is_active_[static_cast<std::size_t>(row)] = true;
  ++active_;
  return true;
}

void DenseQp::drop(int position) {
  is_active_[static_cast<std::size_t>(active_row_[static_cast<std::size_t>(position)])] = false;
  --active_;
  for (int k = position; k < active_; ++k) {
    const auto at = static_cast<std::size_t>(k);
    active_row_[at] = active_row_[at + 1];
    active_sign_[at] = active_sign_[at + 1];
    dual_[k] = dual_[k + 1];
    r_.col(k).head(k + 2) = r_.col(k + 1).head(k + 2);
  }
  // R has a diagonal below its own from there on: turned away.
  for (int k = position; k < active_; ++k) {
    const double a = r_(k, k), b = r_(k + 1, k);
    if (b == 0.0) continue;
    const double length = std::hypot(a, b), c = a / length, s = b / length;
    for (int i = k; i < active_; ++i) {
      const double upper = r_(k, i), lower = r_(k + 1, i);
      r_(k, i) = c * upper + s * lower;
      r_(k + 1, i) = c * lower - s * upper;
    }
    along_ = j_.col(k);
    j_.col(k) = c * along_ + s * j_.col(k + 1);
    j_.col(k + 1) = c * j_.col(k + 1) - s * along_;
  }
}

}  // namespace locograph
