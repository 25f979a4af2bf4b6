#include <locograph/core/vertex_difference.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace locograph::detail {

namespace {

/// Central differences: truncation and rounding balance at ε^(1/3).
constexpr double kDifferenceStep = 6e-6;

}  // namespace

std::size_t ominus_scratch_bytes(int dimension, int state_size) {
  const std::size_t d = static_cast<std::size_t>(dimension),
                    s = static_cast<std::size_t>(state_size);
  return (s * d + d * d + 8 * d + 8 * s) * sizeof(double) + 16 * Scratch::kAlignment;
}

void solve_ominus(int n, int m, const Plus& plus, const double* a, const double* b, double* d,
                  Scratch& scratch) {
  const std::size_t mark = scratch.mark();
  const auto vector = [&](int size) {
    Eigen::Map<Eigen::VectorXd> zero(scratch.array<double>(size), size);
    zero.setZero();
    return zero;
  };
  Eigen::Map<Eigen::VectorXd> difference(d, n), rest = vector(m), ahead = vector(m),
                                                behind = vector(m), step = vector(n);
  const Eigen::Map<const Eigen::VectorXd> target(a, m);
  Eigen::Map<Eigen::MatrixXd> jacobian(scratch.array<double>(static_cast<std::size_t>(m) * n), m,
                                       n);
  Eigen::Map<Eigen::MatrixXd> normal(scratch.array<double>(static_cast<std::size_t>(n) * n), n, n);
  difference.setZero();
  const double small = 1e-12 * (1.0 + target.norm());
  constexpr int kMostSteps = 50;
  for (int i = 0; i < kMostSteps; ++i) {
    std::copy_n(b, m, rest.data());
    plus(b, difference.data(), rest.data());
    rest = target - rest;
    if (rest.norm() <= small) break;
    for (int c = 0; c < n; ++c) {
      std::copy_n(b, m, ahead.data());
      std::copy_n(b, m, behind.data());
      const double here = difference[c];
      difference[c] = here + kDifferenceStep;
      plus(b, difference.data(), ahead.data());
      difference[c] = here - kDifferenceStep;
      plus(b, difference.data(), behind.data());
      difference[c] = here;
      jacobian.col(c) = (ahead - behind) / (2.0 * kDifferenceStep);
    }
    normal.noalias() = jacobian.transpose().lazyProduct(jacobian);
    step.noalias() = jacobian.transpose().lazyProduct(rest);
    Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(normal);
    factor.solveInPlace(step);
    difference += step;
    if (step.norm() <= 1e-15 * (1.0 + difference.norm())) break;
  }
  // The differences are good to 1e-10, and so is what they solve.
  if (!(rest.norm() <= 1e-9 * (1.0 + target.norm()))) {
    difference.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  scratch.rewind(mark);
}

void ominus_jacobian(int n, int m, const Plus& plus, const Minus& minus, const double* a,
                     const double* b, double* jacobian, Scratch& scratch) {
  const std::size_t mark = scratch.mark();
  double* step = scratch.array<double>(n);
  double* moved = scratch.array<double>(m);
  Eigen::Map<Eigen::VectorXd> ahead(scratch.array<double>(n), n);
  Eigen::Map<Eigen::VectorXd> behind(scratch.array<double>(n), n);
  std::fill(step, step + n, 0.0);
  for (int c = 0; c < n; ++c) {
    std::copy_n(a, m, moved);
    step[c] = kDifferenceStep;
    plus(a, step, moved);
    minus(moved, b, ahead.data());
    std::copy_n(a, m, moved);
    step[c] = -kDifferenceStep;
    plus(a, step, moved);
    minus(moved, b, behind.data());
    step[c] = 0.0;
    Eigen::Map<Eigen::VectorXd>(jacobian + static_cast<std::ptrdiff_t>(c) * n, n) =
        (ahead - behind) / (2.0 * kDifferenceStep);
  }
  scratch.rewind(mark);
}

}  // namespace locograph::detail
