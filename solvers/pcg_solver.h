#pragma once
/// Preconditioned conjugate gradients on H with the block-Jacobi preconditioner: for graphs whose
/// factor would not fit, a million poses and more.
///
///     PcgOptions options;                      // tolerance 1e-8, at most 1000 products
///     PcgSolver solver(options);
///     optimise(graph, optimiser_options, solver);
///
/// An inexact solver: solve() is as good as its options say. factorise() copies nothing: the values
/// and the damping it was given must live until the last solve(). It can only tell that a diagonal
/// block is not positive definite; a matrix that is indefinite otherwise ends the iteration early,
/// and the step is refused by Levenberg-Marquardt if it is no descent.

#include <locograph/core/linear_solver.h>
#include <locograph/solvers/pcg_block_jacobi.h>
#include <locograph/solvers/pcg_block_product.h>
#include <locograph/solvers/pcg_iteration.h>

namespace locograph {

class PcgSolver final : public LinearSolver {
 public:
  explicit PcgSolver(const PcgOptions& options = {});
  PcgSolver(const PcgSolver&) = delete;
  PcgSolver& operator=(const PcgSolver&) = delete;

  std::string name() const override { return "pcg"; }
  void use_threads(ThreadPool* threads) override { threads_ = threads; }
  void analyse(const BlockPattern& pattern) override;
  bool factorise(const double* values, const double* damping) override;
  void solve(const double* right_hand_side, double* x) const override;
  int failed_row() const override { return failed_row_; }

  /// Of the last solve().
  int iterations() const { return iterations_; }
  double relative_residual() const { return iteration_.relative_residual(); }

 private:
  PcgOptions options_;
  BlockPattern pattern_;
  BlockProduct product_;
  BlockJacobi preconditioner_;
  ThreadPool* threads_ = nullptr;
  const double* values_ = nullptr;
  const double* damping_ = nullptr;
  int failed_row_ = -1;
  mutable PcgIteration iteration_;
  mutable int iterations_ = 0;
};

}  // namespace locograph
