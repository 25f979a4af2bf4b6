#pragma once
/// Dense Cholesky: the reference every other solver is compared with.

#include <locograph/core/linear_solver.h>

#include <Eigen/Core>

namespace locograph {

class DenseSolver final : public LinearSolver {
 public:
  std::string name() const override { return "dense"; }
  void analyse(const BlockPattern& pattern) override;
  bool factorise(const double* values, const double* damping) override;
  void solve(const double* right_hand_side, double* x) const override;
  int failed_row() const override { return failed_row_; }

  /// Estimated seconds of one factorisation of this pattern.
  static double seconds(const BlockPattern& pattern);

 private:
  BlockPattern pattern_;
  Eigen::MatrixXd factor_;
  int failed_row_ = -1;
};

}  // namespace locograph
