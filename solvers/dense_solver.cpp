#include <locograph/solvers/cost_model.h>
#include <locograph/solvers/dense_solver.h>
#include <locograph/solvers/kernels.h>

#include <algorithm>

namespace locograph {

double DenseSolver::seconds(const BlockPattern& pattern) {
  return panel_seconds(pattern.scalar_size(), 0);
}

void DenseSolver::analyse(const BlockPattern& pattern) {
  pattern_ = pattern;
  factor_.resize(pattern.scalar_size(), pattern.scalar_size());
}

bool DenseSolver::factorise(const double* values, const double* damping) {
  const int n = pattern_.scalar_size();
  failed_row_ = -1;
  factor_.setZero();
  for (int c = 0; c < pattern_.size(); ++c) {
    for (int k = pattern_.column_begin[c]; k < pattern_.column_begin[c + 1]; ++k) {
      const int r = pattern_.row[k];
      const Eigen::Map<const Eigen::MatrixXd> block(values + pattern_.value_offset[k],
                                                    pattern_.dimension[r], pattern_.dimension[c]);
      factor_.block(pattern_.scalar_begin[c], pattern_.scalar_begin[r], block.cols(),
                    block.rows()) = block.transpose();
    }
  }
  for (int i = 0; i < n; ++i) factor_(i, i) += damping[i];
  const int bad = kernels().dense.cholesky_in_place(factor_.data(), n, n, n);
  if (bad < 0) return true;
  failed_row_ = static_cast<int>(std::upper_bound(pattern_.scalar_begin.begin(),
                                                  pattern_.scalar_begin.end(), bad) -
                                 pattern_.scalar_begin.begin()) -
                1;
  return false;
}

void DenseSolver::solve(const double* right_hand_side, double* x) const {
  const int n = pattern_.scalar_size();
  if (x != right_hand_side) std::copy(right_hand_side, right_hand_side + n, x);
  const PanelSolve& panels = kernels().panel;
  panels.forward(factor_.data(), n, n, n, x, false);
  panels.backward(factor_.data(), n, n, n, x, false);
}

}  // namespace locograph
