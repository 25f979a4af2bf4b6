#pragma once
/// y = (H + diag(damping)) x for a symmetric matrix of which the upper blocks are stored.
///
///     BlockProduct product;
///     product.analyse(pattern);                   // keeps a reference to it
///     product.apply(values, damping, x, y, threads);
///
/// One thread reads every block once and uses it for its row and its column; several threads own
/// ranges of rows and read a block once for each. Either way a row adds up its blocks in order of
/// their columns, with the same functions: the same bits.

#include <locograph/common/thread_pool.h>
#include <locograph/core/block_matrix.h>
#include <locograph/solvers/pcg_kernels.h>

#include <vector>

namespace locograph {

class BlockProduct {
 public:
  void analyse(const BlockPattern& pattern);
  /// x and y must not overlap. Does not allocate.
  void apply(const double* values, const double* damping, const double* x, double* y,
             ThreadPool* threads) const;

 private:
  /// A block to the right of the diagonal of its row.
  struct RowBlock {
    int block, column;
  };
  void own_column(int c, const double* values, const double* damping, const double* x,
                  double* y) const;

  const BlockPattern* pattern_ = nullptr;
  const PcgKernels* kernel_ = nullptr;
  std::vector<int> row_begin_, task_begin_;
  std::vector<RowBlock> row_blocks_;
};

}  // namespace locograph
