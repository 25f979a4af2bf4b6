#include <locograph/core/null_space.h>

#include <Eigen/OrderingMethods>
#include <cmath>

namespace locograph {
namespace {

constexpr double kFreePivot = 1e-12;

}  // namespace

NullSpace::NullSpace(Workspace& workspace) {
  const int n = workspace.problem().dimension();
  if (n == 0) return;
  const Sparse hessian = scaled_hessian(workspace);
  const Sparse full = hessian.selfadjointView<Eigen::Upper>();
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
  Eigen::AMDOrdering<int>()(full, inverse);
  order_ = inverse.inverse();
  Sparse upper(n, n);
  upper.selfadjointView<Eigen::Upper>() = hessian.selfadjointView<Eigen::Upper>().twistedBy(order_);
  analyse(upper);
  factorise(upper);
}

/// The upper triangle of D^-½ H D^-½; rows without any measurement stay zero.
NullSpace::Sparse NullSpace::scaled_hessian(Workspace& workspace) {
  const BlockPattern& pattern = workspace.problem().pattern();
  std::vector<double> diagonal(pattern.scalar_size());
  workspace.diagonal(diagonal);
  scale_.resize(pattern.scalar_size());
  for (Eigen::Index i = 0; i < scale_.size(); ++i) {
    scale_[i] = diagonal[i] > 0.0 ? 1.0 / std::sqrt(diagonal[i]) : 1.0;
  }
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(pattern.values()));
  for (int c = 0; c < pattern.size(); ++c) {
    for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
      const int r = pattern.row[k], rows = pattern.dimension[r];
      const double* block = workspace.hessian().data() + pattern.value_offset[k];
      for (int j = 0; j < pattern.dimension[c]; ++j) {
        for (int i = 0; i < rows; ++i) {
          const int row = pattern.scalar_begin[r] + i, column = pattern.scalar_begin[c] + j;
          if (row > column) continue;
          entries.emplace_back(row, column, block[j * rows + i] * scale_[row] * scale_[column]);
        }
      }
    }
  }
  Sparse hessian(pattern.scalar_size(), pattern.scalar_size());
  hessian.setFromTriplets(entries.begin(), entries.end());
  return hessian;
}

/// Elimination tree and the size of each column of L.
void NullSpace::analyse(const Sparse& upper) {
  const int n = static_cast<int>(upper.cols());
  std::vector<int> mark(n);
  parent_.assign(n, -1);
  column_size_.assign(n, 0);
  for (int k = 0; k < n; ++k) {
    mark[k] = k;
    for (Sparse::InnerIterator entry(upper, k); entry; ++entry) {
      for (int i = static_cast<int>(entry.row()); i < k && mark[i] != k; i = parent_[i]) {
        if (parent_[i] < 0) parent_[i] = k;
        ++column_size_[i];
        mark[i] = k;
      }
    }
  }
  column_begin_.assign(n + 1, 0);
  for (int k = 0; k < n; ++k) column_begin_[k + 1] = column_begin_[k] + column_size_[k];
  row_.resize(column_begin_[n]);
  value_.resize(column_begin_[n]);
}

void NullSpace::factorise(const Sparse& upper) {
  const int n = static_cast<int>(upper.cols());
  std::vector<double> y(n, 0.0);
  std::vector<int> mark(n), pattern(n), path(n);
  pivot_.resize(n);
  column_size_.assign(n, 0);
  for (int k = 0; k < n; ++k) {
    int top = n;
    mark[k] = k;
    for (Sparse::InnerIterator entry(upper, k); entry; ++entry) {
      int i = static_cast<int>(entry.row());
      if (i > k) continue;
      y[i] += entry.value();
      int length = 0;
      for (; mark[i] != k; i = parent_[i]) {
        path[length++] = i;
        mark[i] = k;
      }
      while (length > 0) pattern[--top] = path[--length];
    }
    double pivot = y[k];
    y[k] = 0.0;
    for (; top < n; ++top) {
      const int i = pattern[top];
      const double yi = y[i];
      y[i] = 0.0;
      const std::int64_t begin = column_begin_[i], end = begin + column_size_[i];
      for (std::int64_t p = begin; p < end; ++p) y[row_[p]] -= value_[p] * yi;
      const double l = yi / pivot_[i];
      pivot -= l * yi;
      row_[end] = k;
      value_[end] = l;
      ++column_size_[i];
    }
    if (!(pivot > kFreePivot)) {
      free_rows_.push_back(k);
      pivot = 1.0;
    }
    pivot_[k] = pivot;
  }
}

Eigen::VectorXd NullSpace::direction(int i) const {
  const int n = static_cast<int>(pivot_.size());
  Eigen::VectorXd x = Eigen::VectorXd::Unit(n, free_rows_[i]);
  for (int k = 0; k < n; ++k) {
    for (std::int64_t p = column_begin_[k]; p < column_begin_[k + 1]; ++p) {
      x[row_[p]] -= value_[p] * x[k];
    }
  }
  for (int k = 0; k < n; ++k) x[k] /= pivot_[k];
  for (int k = n - 1; k >= 0; --k) {
    for (std::int64_t p = column_begin_[k]; p < column_begin_[k + 1]; ++p) {
      x[k] -= value_[p] * x[row_[p]];
    }
  }
  Eigen::VectorXd step = (order_.inverse() * x).cwiseProduct(scale_);
  step /= step.cwiseAbs().maxCoeff();
  return step;
}

}  // namespace locograph
