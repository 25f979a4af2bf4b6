#include <locograph/solvers/dense_kernels.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

using Panel = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using ConstPanel = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

constexpr int kStrip = 8;  // columns factored together: one AVX-512 register of updates

/// Right-looking within a strip: the strip is short, its rows stay in cache.
int cholesky_strip(double* panel, int ld, int rows, int columns) {
  for (int j = 0; j < columns; ++j) {
    double* column = panel + static_cast<long>(j) * ld;
    const double pivot = column[j];
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return j;
    const double root = std::sqrt(pivot), inverse = 1.0 / root;
    column[j] = root;
    for (int i = j + 1; i < rows; ++i) column[i] *= inverse;
    for (int c = j + 1; c < columns; ++c) {
      double* target = panel + static_cast<long>(c) * ld;
      const double factor = column[c];
      for (int i = c; i < rows; ++i) target[i] -= factor * column[i];
    }
  }
  return -1;
}

}  // namespace

void subtract_product(double* c, int ldc, const double* a, int lda, const double* b, int ldb, int m,
                      int n, int k) {
  Panel target(c, m, n, Eigen::OuterStride<>(ldc));
  const ConstPanel left(a, m, k, Eigen::OuterStride<>(lda));
  const ConstPanel right(b, n, k, Eigen::OuterStride<>(ldb));
  // Eigen packs both factors on the stack up to a limit, beyond it on the heap: stay below.
  constexpr int kMostInner = 256;
  constexpr int kMostPacked = EIGEN_STACK_ALLOCATION_LIMIT / sizeof(double);
  for (int p = 0; p < k; p += kMostInner) {
    const int inner = std::min(kMostInner, k - p);
    const int most = kMostPacked / inner;
    for (int j = 0; j < n; j += most) {
      const int columns = std::min(most, n - j);
      for (int i = 0; i < m; i += most) {
        const int rows = std::min(most, m - i);
        target.block(i, j, rows, columns).noalias() -=
            left.block(i, p, rows, inner) * right.block(j, p, columns, inner).transpose();
      }
    }
  }
}

int cholesky_in_place(double* panel, int ld, int rows, int columns) {
  for (int j = 0; j < columns; j += kStrip) {
    const int width = std::min(kStrip, columns - j);
    double* strip = panel + static_cast<long>(j) * ld + j;
    const int bad = cholesky_strip(strip, ld, rows - j, width);
    if (bad >= 0) return j + bad;
    const int next = j + width;
    if (next >= columns) break;
    // What is left of the panel, a strip at a time, so that the upper triangle is not computed.
    for (int t = next; t < columns; t += kStrip) {
      const int n = std::min(kStrip, columns - t);
      subtract_product(panel + static_cast<long>(t) * ld + t, ld,
                       panel + static_cast<long>(j) * ld + t, ld,
                       panel + static_cast<long>(j) * ld + t, ld, rows - t, n, width);
    }
  }
  return -1;
}

void solve_lower(const double* l, int ld, int n, double* x) {
  for (int j = 0; j < n; ++j) {
    const double* column = l + static_cast<long>(j) * ld;
    const double value = x[j] /= column[j];
    for (int i = j + 1; i < n; ++i) x[i] -= column[i] * value;
  }
}

void solve_lower_transposed(const double* l, int ld, int n, double* x) {
  for (int j = n - 1; j >= 0; --j) {
    const double* column = l + static_cast<long>(j) * ld;
    double sum = x[j];
    for (int i = j + 1; i < n; ++i) sum -= column[i] * x[i];
    x[j] = sum / column[j];
  }
}

}  // namespace locograph
