#pragma once
/// The difference of two states of a vertex, a ⊟ b: by the type's own ominus(), or by solving
/// b ⊞ d = a with Gauss-Newton and differences, which serves every type whose ⊞ is smooth.

#include <locograph/core/scratch.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace locograph::detail {

inline std::size_t ominus_scratch_bytes(int dimension, int state_size) {
  const std::size_t d = static_cast<std::size_t>(dimension),
                    s = static_cast<std::size_t>(state_size);
  return (s * d + d * d + 8 * d + 8 * s) * sizeof(double) + 16 * Scratch::kAlignment;
}

/// Central differences: truncation and rounding balance at ε^(1/3).
inline constexpr double kDifferenceStep = 6e-6;

template <class V>
void solve_ominus(const V& vertex, const double* a, const double* b, double* d, Scratch& scratch) {
  const int n = vertex.dimension(), m = vertex.state_size();
  const std::size_t mark = scratch.mark();
  const auto vector = [&](int size) {
    Eigen::Map<Eigen::VectorXd> zero(scratch.array<double>(size), size);
    zero.setZero();
    return zero;
  };
  Eigen::Map<Eigen::VectorXd> difference(d, n), rest = vector(m), plus = vector(m),
                                                minus = vector(m), step = vector(n);
  const Eigen::Map<const Eigen::VectorXd> target(a, m);
  Eigen::Map<Eigen::MatrixXd> jacobian(scratch.array<double>(std::size_t(m) * n), m, n);
  Eigen::Map<Eigen::MatrixXd> normal(scratch.array<double>(std::size_t(n) * n), n, n);
  difference.setZero();
  const double small = 1e-12 * (1.0 + target.norm());
  constexpr int kMostSteps = 50;
  for (int i = 0; i < kMostSteps; ++i) {
    std::copy_n(b, m, rest.data());
    vertex.oplus(b, difference.data(), rest.data());
    rest = target - rest;
    if (rest.norm() <= small) break;
    for (int c = 0; c < n; ++c) {
      std::copy_n(b, m, plus.data());
      std::copy_n(b, m, minus.data());
      const double here = difference[c];
      difference[c] = here + kDifferenceStep;
      vertex.oplus(b, difference.data(), plus.data());
      difference[c] = here - kDifferenceStep;
      vertex.oplus(b, difference.data(), minus.data());
      difference[c] = here;
      jacobian.col(c) = (plus - minus) / (2.0 * kDifferenceStep);
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

template <class V>
void ominus(const V& vertex, const double* a, const double* b, double* d,
            [[maybe_unused]] Scratch& scratch) {
  if constexpr (requires { vertex.ominus(a, b, d); }) {
    vertex.ominus(a, b, d);
  } else {
    solve_ominus(vertex, a, b, d, scratch);
  }
}

template <class V>
void ominus_jacobian(const V& vertex, const double* a, const double* b, double* jacobian,
                     Scratch& scratch) {
  const int n = vertex.dimension(), m = vertex.state_size();
  if constexpr (requires { V::kFlat; }) {
    Eigen::Map<Eigen::MatrixXd>(jacobian, n, n).setIdentity();
    return;
  }
  const std::size_t mark = scratch.mark();
  double* step = scratch.array<double>(n);
  double* moved = scratch.array<double>(m);
  Eigen::Map<Eigen::VectorXd> plus(scratch.array<double>(n), n);
  Eigen::Map<Eigen::VectorXd> minus(scratch.array<double>(n), n);
  std::fill(step, step + n, 0.0);
  for (int c = 0; c < n; ++c) {
    std::copy_n(a, m, moved);
    step[c] = kDifferenceStep;
    vertex.oplus(a, step, moved);
    ominus(vertex, moved, b, plus.data(), scratch);
    std::copy_n(a, m, moved);
    step[c] = -kDifferenceStep;
    vertex.oplus(a, step, moved);
    ominus(vertex, moved, b, minus.data(), scratch);
    step[c] = 0.0;
    Eigen::Map<Eigen::VectorXd>(jacobian + static_cast<std::ptrdiff_t>(c) * n, n) =
        (plus - minus) / (2.0 * kDifferenceStep);
  }
  scratch.rewind(mark);
}

}  // namespace locograph::detail
