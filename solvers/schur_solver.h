#pragma once
/// The Schur complement: vertices marked for elimination are taken out one by one, what is left is
/// solved by another solver.
///
///     graph.set_eliminate(landmark, true);               // for every landmark
///     optimise(graph, options, *make_linear_solver("schur"));
///
/// With the kept block rows first, H + damping = [B E; Eᵀ C] and C block-diagonal,
///
///   S x₁ = b₁ − E C⁻¹ b₂,   S = B − E C⁻¹ Eᵀ,   C x₂ = b₂ − Eᵀ x₁
///
/// (Brown 1958; Triggs et al. 2000, section 6.1). S is formed straight into the blocks it has, or,
/// with conjugate gradients, never formed: products with it go through E, and the preconditioner is
/// the inverse of its diagonal blocks (Schur-Jacobi).
///
/// schur-dense    dense Cholesky of S: all cameras see common points
/// schur-sparse   block-sparse Cholesky of S: streets, cities, long trajectories
/// schur-pcg      conjugate gradients on S: inexact, as good as its PcgOptions say
/// schur          the cheapest of the three by estimated cost, decided in analyse()
///
/// analyse() throws Error when two eliminated vertices share an edge. Without eliminated rows the
/// solver of S solves the whole system. The bits of a solution do not depend on the threads.

#include <locograph/core/linear_solver.h>
#include <locograph/solvers/pcg_block_jacobi.h>
#include <locograph/solvers/pcg_block_product.h>
#include <locograph/solvers/pcg_iteration.h>
#include <locograph/solvers/schur_structure.h>

#include <memory>

namespace locograph {

class SchurSolver final : public LinearSolver {
 public:
  enum class Reduced { kAutomatic, kDense, kSparse, kPcg };

  /// Conjugate gradients are meant for inexact steps: a hundredth of the residual is left, which
  /// costs Levenberg-Marquardt a few more iterations and saves most of the products.
  explicit SchurSolver(Reduced reduced = Reduced::kAutomatic,
                       const PcgOptions& pcg = {.relative_tolerance = 1e-2, .max_iterations = 300});
  SchurSolver(const SchurSolver&) = delete;
  SchurSolver& operator=(const SchurSolver&) = delete;

  std::string name() const override;
  void use_threads(ThreadPool* threads) override;
  void analyse(const BlockPattern& pattern) override;
  /// With conjugate gradients the values and the damping must live until the last solve().
  bool factorise(const double* values, const double* damping) override;
  void solve(const double* right_hand_side, double* x) const override;
  int failed_row() const override { return failed_row_; }

  /// Multiply-adds of one factorisation (and, with conjugate gradients, an estimate of the solve);
  /// valid after analyse().
  double cost() const { return cost_; }

 private:
  static constexpr int kChunk = 256;  ///< eliminated columns that one thread takes at a time

  void choose();
  bool threaded() const { return threads_ != nullptr && threads_->size() > 1; }
  int chunks() const { return (structure_.eliminated() + kChunk - 1) / kChunk; }
  /// f(column) for all eliminated columns, on the threads there are.
  template <class F>
  void each_column(F&& f) const;
  bool eliminate_column(int column, const double* values, const double* damping);
  int eliminate_and_form(const double* values, const double* damping);
  void form_preconditioner(const double* values, const double* damping);
  /// y −= W t on the kept rows, t on the eliminated ones: y = x[0…], t = x[eliminated rows…].
  void scatter(const double* t, double* y) const;
  void multiply(const double* v, double* out) const;

  Reduced wanted_, chosen_;
  PcgOptions pcg_options_;
  ThreadPool* threads_ = nullptr;
  BlockPattern pattern_;
  SchurStructure structure_;
  std::vector<double> factor_;  ///< W and L
  std::vector<double> reduced_, no_damping_;
  std::unique_ptr<LinearSolver> solver_;  ///< of S; null with conjugate gradients
  BlockProduct product_;
  BlockJacobi preconditioner_;
  std::vector<int> failed_in_chunk_;
  const double* values_ = nullptr;
  const double* damping_ = nullptr;
  mutable PcgIteration iteration_;
  mutable std::vector<double> eliminated_part_;
  double cost_ = 0.0;
  int failed_row_ = -1;
  bool analysed_ = false;
};

}  // namespace locograph
