#pragma once
/// The block-Jacobi preconditioner: the inverses of a matrix's diagonal blocks.
///
///     BlockJacobi preconditioner;
///     preconditioner.analyse(pattern);
///     preconditioner.load(values, damping);       // diagonal blocks of H + diag(damping)
///     int bad = preconditioner.invert(threads);   // -1, or the first block that is not positive
///     preconditioner.apply(r, z, threads);        // z = M⁻¹ r
///
/// A Schur complement loads the blocks of B and subtracts its own terms before it inverts.

#include <locograph/common/thread_pool.h>
#include <locograph/core/block_matrix.h>
#include <locograph/solvers/pcg_kernels.h>

#include <vector>

namespace locograph {

class BlockJacobi {
 public:
  /// Keeps a reference to the pattern.
  void analyse(const BlockPattern& pattern);
  void load(const double* values, const double* damping);
  double* blocks() { return blocks_.data(); }
  /// Offset of each block row's block in blocks().
  const std::int64_t* places() const { return place_.data(); }
  int invert(ThreadPool* threads);
  void apply(const double* r, double* z, ThreadPool* threads) const;

 private:
  int invert_range(int begin, int end, double* work);

  const BlockPattern* pattern_ = nullptr;
  const PcgKernels* kernel_ = nullptr;
  std::vector<std::int64_t> place_;
  std::vector<double> blocks_, work_;
  std::vector<int> task_begin_, failed_;
  int widest_ = 0;
};

}  // namespace locograph
