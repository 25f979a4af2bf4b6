#include <locograph/solvers/eigen_solver.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace locograph {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

Eigen::Map<const Matrix> view(const ScalarMatrix& m) {
  return {m.size,         m.size,       static_cast<Eigen::Index>(m.row.size()),
          m.begin.data(), m.row.data(), m.value.data()};
}

}  // namespace

struct EigenSolver::Factor {
  Eigen::SimplicialLLT<Matrix, Eigen::Upper> llt;
};

EigenSolver::EigenSolver() : factor_(std::make_unique<Factor>()) {}
EigenSolver::~EigenSolver() = default;

void EigenSolver::analyse(const BlockPattern& pattern) {
  if (pattern == pattern_) return;
  pattern_ = pattern;
  matrix_ = ScalarMatrix(pattern);
  if (matrix_.size != 0) factor_->llt.analyzePattern(view(matrix_));
}

bool EigenSolver::factorise(const double* values, const double* damping) {
  failed_row_ = -1;
  if (matrix_.size == 0) return true;
  matrix_.set(pattern_, values, damping);
  factor_->llt.factorize(view(matrix_));
  // It takes NaN for a positive pivot.
  if (factor_->llt.info() == Eigen::Success &&
      Matrix(factor_->llt.matrixL()).coeffs().isFinite().all()) {
    return true;
  }
  failed_row_ = find_failed_row(pattern_, values, damping);
  return false;
}

void EigenSolver::solve(const double* right_hand_side, double* x) const {
  if (matrix_.size == 0) return;
  const Eigen::Map<const Eigen::VectorXd> b(right_hand_side, matrix_.size);
  Eigen::Map<Eigen::VectorXd>(x, matrix_.size) = factor_->llt.solve(b).eval();
}

}  // namespace locograph
