#pragma once
/// Block-sparse Cholesky: multifrontal, on supernodes of block columns.
///
///     BlockCholesky solver;
///     solver.use_threads(&threads);                   // optional; the same bits
///     solver.analyse(pattern);
///     if (solver.factorise(values, damping)) solver.solve(rhs, x);
///
/// The order is minimum degree or nested dissection on the block pattern, whichever is estimated
/// to be faster. A front gathers its columns of H and the update matrices of its children, factors
/// its pivot columns and leaves an update matrix to its parent (Duff & Reid 1983; Liu 1992);
/// everything in it is dense and runs in kernels whose tiles are register-sized. Subtrees run side
/// by side; a thread that has no front helps with the front of another. Every number is computed by
/// one thread in an order of operations that is fixed by the pattern.

#include <locograph/core/linear_solver.h>
#include <locograph/solvers/aligned_memory.h>
#include <locograph/solvers/kernels.h>
#include <locograph/solvers/supernodes.h>

#include <cstdint>
#include <vector>

namespace locograph {

class BlockCholesky final : public LinearSolver {
 public:
  std::string name() const override { return "block-cholesky"; }
  void use_threads(ThreadPool* threads) override;
  void analyse(const BlockPattern& pattern) override;
  /// Like analyse(), if the factorisation is estimated to take less than `seconds`; false if not,
  /// and the solver is as it was when the pattern is new.
  bool analyse_if_below(const BlockPattern& pattern, double seconds);
  bool factorise(const double* values, const double* damping) override;
  void solve(const double* right_hand_side, double* x) const override;
  /// Blocks inside the pattern of the factor come from the recursion of Takahashi, Fagan & Chin
  /// (1973), front by front from the root; others from one solution for each scalar column.
  bool inverse_blocks(const BlockPattern& pattern, std::span<const std::pair<int, int>> blocks,
                      double* out) const override;
  int failed_row() const override { return failed_row_; }

  /// After analyse(): the symbolic factorisation, the estimated seconds of one factorisation, its
  /// multiply-adds and the numbers in the factor, zeros of joined columns included.
  const Supernodes& structure() const { return s_; }
  double seconds() const { return seconds_; }
  double multiply_adds() const;
  std::int64_t factor_size() const;
  /// "minimum degree" or "nested dissection".
  const char* order() const { return nested_ ? "nested dissection" : "minimum degree"; }

 private:
  /// Where a block of H goes in a panel.
  struct Entry {
    std::int64_t from;
    std::int64_t to;
    int leading;
    short rows, columns;  ///< of the block of H
    bool transposed;
  };

  void reserve_updates();
  void place_entries();
  void assemble_entries(int supernode, const double* values, const double* damping);
  /// The update matrix of a front that `thread` works on, or whose parent it works on.
  double* update_matrix(int supernode, int thread);
  void add_child(int child, int thread, bool pivots, int begin, int end);
  /// Both return the scalar column that failed, or -1.
  int factorise_front(int supernode, const double* values, const double* damping, int thread);
  int factorise_front_together(int supernode, const double* values, const double* damping,
                               const ItemRunner::Crew& crew);
  bool worth_sharing(int supernode) const;
  void forward(int supernode, const double* right_hand_side) const;
  void backward(int supernode, double* x) const;

  const Kernels& kernels_ = kernels();
  BlockPattern pattern_;
  Supernodes s_;
  std::vector<Entry> entries_;
  std::vector<std::int64_t> entry_begin_;  ///< by supernode
  AlignedMemory factor_, updates_;  ///< updates_: the shared ones, then a stack for each thread
  mutable AlignedMemory vectors_;
  std::vector<int> failed_;  ///< block column that failed, of an item that did
  mutable ItemRunner runner_;
  ThreadPool* threads_ = nullptr;
  double seconds_ = 0.0;
  bool nested_ = false;
  int failed_row_ = -1;
};

}  // namespace locograph
