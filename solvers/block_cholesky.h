#pragma once
/// Block-sparse Cholesky: left-looking, minimum-degree order on the block pattern, kernels of
/// compile-time size where all blocks have the same one (3 or 6).
///
/// Blocks of the factor are column-major with a leading dimension rounded up to a power of two, so
/// that a column of a 6 × 6 block is one vector register. A left-looking column c gathers
/// A(:,c) − Σ_k L(:,k) L(c,k)ᵀ over the columns k of its row, then factors its diagonal block.

#include <locograph/core/linear_solver.h>

#include <cstdint>
#include <vector>

namespace locograph {

class BlockCholesky final : public LinearSolver {
 public:
  std::string name() const override { return "block-cholesky"; }
  void analyse(const BlockPattern& pattern) override;
  bool factorise(const double* values, const double* damping) override;
  void solve(const double* right_hand_side, double* x) const override;
  int failed_row() const override { return failed_row_; }

  /// Multiply-adds of one factorisation; valid after analyse().
  double cost() const { return cost_; }
  /// Blocks of the factor, diagonal included.
  std::int64_t factor_blocks() const { return static_cast<std::int64_t>(rows_.size()); }

 private:
  /// Where a block of H goes in the factor.
  struct Entry {
    std::int64_t from;
    std::int64_t to;
    int rows, columns;  ///< of the block of H
    bool transposed;
  };
  /// A block L(c, k) left of the diagonal of row c: its position among the blocks of column k.
  struct RowBlock {
    int column;
    int position;
  };

  void order();
  void symbolic();
  void place_entries();
  template <class Kernel>
  int factorise_columns(const Kernel& kernel);
  template <class Kernel>
  void solve_columns(const Kernel& kernel, double* y) const;

  BlockPattern pattern_;
  std::vector<int> old_of_new_, new_of_old_;
  std::vector<int> dimension_;     ///< by new index
  std::vector<int> scalar_begin_;  ///< by new index
  std::vector<int> column_begin_;  ///< blocks of the factor by column, rows ascending
  std::vector<int> rows_;
  std::vector<std::int64_t> offset_;  ///< of each block in factor_
  std::vector<int> row_begin_;
  std::vector<RowBlock> row_blocks_;
  std::vector<Entry> entries_;
  std::vector<double> factor_;
  std::vector<int> position_;  ///< work: block of the current column by row
  mutable std::vector<double> permuted_;
  int uniform_ = 0;  ///< the block size all share, 0 if none
  double cost_ = 0.0;
  int failed_row_ = -1;
};

}  // namespace locograph
