#pragma once
/// Eigen::SimplicialLLT behind our interface: scalar sparse Cholesky, an independent check of ours.
/// Allocates in factorise(), unlike ours.

#include <locograph/core/linear_solver.h>
#include <locograph/solvers/scalar_matrix.h>

#include <memory>

namespace locograph {

class EigenSolver final : public LinearSolver {
 public:
  EigenSolver();
  ~EigenSolver() override;

  std::string name() const override { return "eigen"; }
  void analyse(const BlockPattern& pattern) override;
  bool factorise(const double* values, const double* damping) override;
  void solve(const double* right_hand_side, double* x) const override;
  int failed_row() const override { return failed_row_; }

 private:
  struct Factor;
  BlockPattern pattern_;
  ScalarMatrix matrix_;
  std::unique_ptr<Factor> factor_;
  int failed_row_ = -1;
};

}  // namespace locograph
