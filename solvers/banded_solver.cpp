#include <locograph/solvers/banded_solver.h>
#include <locograph/solvers/cost_model.h>
#include <locograph/solvers/kernels.h>

#include <algorithm>

namespace locograph {

std::vector<int> BandedSolver::panel_ends(const BlockPattern& pattern) {
  std::vector<int> last(pattern.size());
  for (int c = 0; c < pattern.size(); ++c) {
    last[c] = c;
    for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
      last[pattern.row[k]] = c;
    }
  }
  // Eliminating column c joins its rows: each of them reaches as far as the last.
  for (int c = 0; c < pattern.size(); ++c) {
    if (c + 1 <= last[c]) last[c + 1] = std::max(last[c + 1], last[c]);
  }
  return last;
}

double BandedSolver::seconds(const BlockPattern& pattern) {
  const std::vector<int> last = panel_ends(pattern);
  double total = 0.0;
  for (int c = 0; c < pattern.size(); ++c) {
    const int below = pattern.scalar_begin[last[c] + 1] - pattern.scalar_begin[c + 1];
    total += panel_seconds(pattern.dimension[c], below);
  }
  return total;
}

void BandedSolver::analyse(const BlockPattern& pattern) {
  if (pattern == pattern_) return;
  pattern_ = pattern;
  last_ = panel_ends(pattern);
  panel_begin_.assign(1, 0);
  height_.clear();
  // Blocks of the pattern are copied whole; the others are those that fill in.
  std::vector<int> blocks(pattern.size(), 0);
  for (const int row : pattern.row) ++blocks[row];
  fills_.clear();
  for (int c = 0; c < pattern.size(); ++c) {
    height_.push_back(pattern.scalar_begin[last_[c] + 1] - pattern.scalar_begin[c]);
    panel_begin_.push_back(panel_begin_.back() +
                           static_cast<std::size_t>(height_[c]) * pattern.dimension[c]);
    if (blocks[c] <= last_[c] - c) fills_.push_back(c);
  }
  panels_.reserve(static_cast<std::int64_t>(panel_begin_.back()));
}

bool BandedSolver::factorise(const double* values, const double* damping) {
  failed_row_ = -1;
  const DenseKernels& dense = kernels().dense;
  for (const int c : fills_) {
    std::fill(panels_.data() + panel_begin_[c], panels_.data() + panel_begin_[c + 1], 0.0);
  }
  // The upper block (r, c) of the pattern is the transpose of the lower block (c, r) of panel r.
  for (int c = 0; c < pattern_.size(); ++c) {
    const int columns = pattern_.dimension[c];
    for (int k = pattern_.column_begin[c]; k < pattern_.column_begin[c + 1]; ++k) {
      const int r = pattern_.row[k], rows = pattern_.dimension[r];
      const double* block = values + pattern_.value_offset[k];
      double* target =
          panels_.data() + panel_begin_[r] + pattern_.scalar_begin[c] - pattern_.scalar_begin[r];
      for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) target[i * height_[r] + j] = block[j * rows + i];
      }
    }
  }
  for (int c = 0; c < pattern_.size(); ++c) {
    const int n = pattern_.dimension[c], height = height_[c];
    double* panel = panels_.data() + panel_begin_[c];
    for (int i = 0; i < n; ++i) panel[i * height + i] += damping[pattern_.scalar_begin[c] + i];
    if (dense.cholesky_in_place(panel, height, height, n) >= 0) {
      failed_row_ = c;
      return false;
    }
    for (int t = c + 1; t <= last_[c]; ++t) {
      const int row = pattern_.scalar_begin[t] - pattern_.scalar_begin[c];
      dense.subtract_lower_product(panels_.data() + panel_begin_[t], height_[t], panel + row,
                                   height, height - row, pattern_.dimension[t], n);
    }
  }
  return true;
}

void BandedSolver::solve(const double* right_hand_side, double* x) const {
  if (x != right_hand_side) std::copy_n(right_hand_side, pattern_.scalar_size(), x);
  const PanelSolve& panels = kernels().panel;
  for (int c = 0; c < pattern_.size(); ++c) {
    panels.forward(panels_.data() + panel_begin_[c], height_[c], height_[c], pattern_.dimension[c],
                   x + pattern_.scalar_begin[c], false);
  }
  for (int c = pattern_.size() - 1; c >= 0; --c) {
    panels.backward(panels_.data() + panel_begin_[c], height_[c], height_[c], pattern_.dimension[c],
                    x + pattern_.scalar_begin[c], false);
  }
}

}  // namespace locograph
