#pragma once
/// What an algorithm asks of a linear solver: (H + diag(damping)) x = right-hand side, H symmetric
/// positive definite and block-sparse.
///
///     std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");   // locograph/solvers
///     solver->analyse(pattern);                      // symbolic; nothing happens if it is the
///     same if (solver->factorise(H, damping)) solver->solve(rhs, x);
///
/// After analyse(), factorise() and solve() do not allocate. Not thread-safe.

#include <locograph/common/thread_pool.h>
#include <locograph/core/block_matrix.h>

#include <string>

namespace locograph {

class LinearSolver {
 public:
  virtual ~LinearSolver() = default;

  virtual std::string name() const = 0;
  /// Threads to use from now on, null for the caller's alone. The bits of a result never depend on
  /// it. The pool must outlive the solver's use.
  virtual void use_threads(ThreadPool* /*threads*/) {}
  /// Ordering and symbolic factorisation; cheap when the pattern is the one it already has.
  virtual void analyse(const BlockPattern& pattern) = 0;
  /// values: as laid out by the pattern; damping: one number ≥ 0 for each scalar row. False when
  /// the matrix is not positive definite; failed_row() then says where.
  virtual bool factorise(const double* values, const double* damping) = 0;
  /// x may be the right-hand side itself.
  virtual void solve(const double* right_hand_side, double* x) const = 0;
  /// Block row at which the last factorisation failed, -1 when it did not.
  virtual int failed_row() const { return -1; }
};

}  // namespace locograph
