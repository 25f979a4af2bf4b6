#include <locograph/core/all_zero.h>
#include <locograph/solvers/banded_solver.h>
#include <locograph/solvers/cost_model.h>
#include <locograph/solvers/kernels.h>

#include <algorithm>

namespace locograph {

template <class Counts>
void BandedSolver::find_panel_ends(const BlockPattern& pattern, Counts&& counts,
                                   std::vector<int>& last) {
  last.resize(static_cast<std::size_t>(pattern.size()));
  for (int c = 0; c < pattern.size(); ++c) {
    last[c] = c;
    for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
      if (counts(k)) last[pattern.row[k]] = c;
    }
  }
  // Eliminating column c joins its rows: each of them reaches as far as the last.
  for (int c = 0; c < pattern.size(); ++c) {
    if (c + 1 <= last[c]) last[c + 1] = std::max(last[c + 1], last[c]);
  }
}

double BandedSolver::seconds(const BlockPattern& pattern) {
  std::vector<int> last;
  find_panel_ends(
      pattern, [](int) { return true; }, last);
  double total = 0.0;
  for (int c = 0; c < pattern.size(); ++c) {
    const int below = pattern.scalar_begin[last[c] + 1] - pattern.scalar_begin[c + 1];
    total += panel_seconds(pattern.dimension[c], below);
  }
  return total;
}

void BandedSolver::analyse(const BlockPattern& pattern) {
  if (pattern == pattern_) return;
  pattern_ = {};  // until there is memory for it
  find_panel_ends(
      pattern, [](int) { return true; }, last_);
  panel_begin_.assign(1, 0);
  stride_.clear();
  for (int c = 0; c < pattern.size(); ++c) {
    stride_.push_back(pattern.scalar_begin[last_[c] + 1] - pattern.scalar_begin[c]);
    panel_begin_.push_back(panel_begin_.back() +
                           static_cast<std::size_t>(stride_[c]) * pattern.dimension[c]);
  }
  counts_.resize(pattern.row.size());
  height_.resize(stride_.size());
  blocks_.resize(stride_.size());
  panels_.reserve(static_cast<std::int64_t>(panel_begin_.back()));
  pattern_ = pattern;
}

void BandedSolver::gather(const double* values) {
  std::ranges::fill(blocks_, 0);
  for (int c = 0; c < pattern_.size(); ++c) {
    for (int k = pattern_.column_begin[c]; k < pattern_.column_begin[c + 1]; ++k) {
      const int r = pattern_.row[k];
      counts_[k] = r == c || !all_zero(values + pattern_.value_offset[k],
                                       pattern_.dimension[r] * pattern_.dimension[c]);
      blocks_[r] += counts_[k];
    }
  }
  find_panel_ends(
      pattern_, [this](int k) { return counts_[k] != 0; }, last_);
  for (int c = 0; c < pattern_.size(); ++c) {
    height_[c] = pattern_.scalar_begin[last_[c] + 1] - pattern_.scalar_begin[c];
    // Blocks that count are copied whole; the others are those that fill in.
    if (blocks_[c] > last_[c] - c) continue;
    double* panel = panels_.data() + panel_begin_[c];
    for (int i = 0; i < pattern_.dimension[c]; ++i) {
      std::fill_n(panel + static_cast<std::ptrdiff_t>(i) * stride_[c], height_[c], 0.0);
    }
  }
  // The upper block (r, c) of the pattern is the transpose of the lower block (c, r) of panel r.
  for (int c = 0; c < pattern_.size(); ++c) {
    const int columns = pattern_.dimension[c];
    for (int k = pattern_.column_begin[c]; k < pattern_.column_begin[c + 1]; ++k) {
      if (counts_[k] == 0) continue;
      const int r = pattern_.row[k], rows = pattern_.dimension[r];
      const double* block = values + pattern_.value_offset[k];
      double* target =
          panels_.data() + panel_begin_[r] + pattern_.scalar_begin[c] - pattern_.scalar_begin[r];
      for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) target[i * stride_[r] + j] = block[j * rows + i];
      }
    }
  }
}

bool BandedSolver::factorise(const double* values, const double* damping) {
  failed_row_ = -1;
  const DenseKernels& dense = kernels().dense;
  gather(values);
  for (int c = 0; c < pattern_.size(); ++c) {
    const int n = pattern_.dimension[c], height = height_[c], stride = stride_[c];
    double* panel = panels_.data() + panel_begin_[c];
    for (int i = 0; i < n; ++i) panel[i * stride + i] += damping[pattern_.scalar_begin[c] + i];
    if (dense.cholesky_in_place(panel, stride, height, n) >= 0) {
      failed_row_ = c;
      return false;
    }
    for (int t = c + 1; t <= last_[c]; ++t) {
      const int row = pattern_.scalar_begin[t] - pattern_.scalar_begin[c];
      dense.subtract_lower_product(panels_.data() + panel_begin_[t], stride_[t], panel + row,
                                   stride, height - row, pattern_.dimension[t], n);
    }
  }
  return true;
}

void BandedSolver::solve(const double* right_hand_side, double* x) const {
  if (x != right_hand_side) std::copy_n(right_hand_side, pattern_.scalar_size(), x);
  const PanelSolve& panels = kernels().panel;
  for (int c = 0; c < pattern_.size(); ++c) {
    panels.forward(panels_.data() + panel_begin_[c], stride_[c], height_[c], pattern_.dimension[c],
                   x + pattern_.scalar_begin[c], false);
  }
  for (int c = pattern_.size() - 1; c >= 0; --c) {
    panels.backward(panels_.data() + panel_begin_[c], stride_[c], height_[c], pattern_.dimension[c],
                    x + pattern_.scalar_begin[c], false);
  }
}

}  // namespace locograph
