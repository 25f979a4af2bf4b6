#include <locograph/solvers/kernels.h>
#include <locograph/solvers/pcg_block_product.h>
#include <locograph/solvers/pcg_iteration.h>

#include <algorithm>

namespace locograph {
namespace {

const PcgKernels& kernel_for(const BlockPattern& pattern) {
  const int first = pattern.size() > 0 ? pattern.dimension[0] : 0;
  for (const int d : pattern.dimension) {
    if (d != first) return kernels().pcg(0);
  }
  return kernels().pcg(first);
}

}  // namespace

void BlockProduct::analyse(const BlockPattern& pattern) {
  pattern_ = &pattern;
  kernel_ = &kernel_for(pattern);
  const int n = pattern.size();
  row_begin_.assign(n + 1, 0);
  for (int c = 0; c < n; ++c) {
    for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
      if (pattern.row[k] != c) ++row_begin_[pattern.row[k] + 1];
    }
  }
  for (int r = 0; r < n; ++r) row_begin_[r + 1] += row_begin_[r];
  row_blocks_.resize(row_begin_[n]);
  std::vector<int> next(row_begin_.begin(), row_begin_.end() - 1);
  for (int c = 0; c < n; ++c) {
    for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
      if (pattern.row[k] != c) row_blocks_[next[pattern.row[k]]++] = {k, c};
    }
  }
  task_begin_ = task_beginnings(n);
}

/// What column c gives its own row: the blocks above the diagonal, transposed, and the diagonal.
void BlockProduct::own_column(int c, const double* values, const double* damping, const double* x,
                              double* y) const {
  const BlockPattern& p = *pattern_;
  const int at = p.scalar_begin[c], n = p.dimension[c];
  for (int k = p.column_begin[c]; k < p.column_begin[c + 1]; ++k) {
    const int r = p.row[k];
    kernel_->add_transposed(values + p.value_offset[k], p.dimension[r], n, x + p.scalar_begin[r],
                            y + at);
  }
  for (int i = 0; i < n; ++i) y[at + i] += damping[at + i] * x[at + i];
}

void BlockProduct::apply(const double* values, const double* damping, const double* x, double* y,
                         ThreadPool* threads) const {
  const BlockPattern& p = *pattern_;
  std::fill(y, y + p.scalar_size(), 0.0);
  if (threads == nullptr || threads->size() == 1) {
    for (int c = 0; c < p.size(); ++c) {
      for (int k = p.column_begin[c]; k < p.column_begin[c + 1]; ++k) {
        const int r = p.row[k];
        if (r == c) continue;
        kernel_->add(values + p.value_offset[k], p.dimension[r], p.dimension[c],
                     x + p.scalar_begin[c], y + p.scalar_begin[r]);
      }
      own_column(c, values, damping, x, y);
    }
    return;
  }
  threads->run(static_cast<int>(task_begin_.size()) - 1, [&](int task) {
    for (int r = task_begin_[task]; r < task_begin_[task + 1]; ++r) {
      own_column(r, values, damping, x, y);
      for (int b = row_begin_[r]; b < row_begin_[r + 1]; ++b) {
        const RowBlock& block = row_blocks_[b];
        kernel_->add(values + p.value_offset[block.block], p.dimension[r],
                     p.dimension[block.column], x + p.scalar_begin[block.column],
                     y + p.scalar_begin[r]);
      }
    }
  });
}

}  // namespace locograph
