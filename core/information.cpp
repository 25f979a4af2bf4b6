#include <locograph/core/information.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace locograph {

bool is_symmetric(const Eigen::Ref<const Eigen::MatrixXd>& information) {
  if (information.rows() != information.cols()) return false;
  const double scale = information.cwiseAbs().maxCoeff();
  return (information - information.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * scale;
}

bool is_positive_semidefinite(const Eigen::Ref<const Eigen::MatrixXd>& information) {
  const int n = static_cast<int>(information.rows());
  // Cheap proof first: a Cholesky factor exists. Only when it does not are eigenvalues needed.
  if (n <= 16) {
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 16, 16> factor = information;
    bool positive = true;
    for (int j = 0; j < n && positive; ++j) {
      double pivot = factor(j, j);
      for (int k = 0; k < j; ++k) pivot -= factor(j, k) * factor(j, k);
      positive = pivot > 0.0;
      if (!positive) break;
      const double root = std::sqrt(pivot);
      factor(j, j) = root;
      for (int i = j + 1; i < n; ++i) {
        double sum = factor(i, j);
        for (int k = 0; k < j; ++k) sum -= factor(i, k) * factor(j, k);
        factor(i, j) = sum / root;
      }
    }
    if (positive) return true;
  } else if (Eigen::LLT<Eigen::MatrixXd>(information).info() == Eigen::Success) {
    return true;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(Eigen::MatrixXd(information),
                                                              Eigen::EigenvaluesOnly);
  const Eigen::VectorXd& eigenvalues = solver.eigenvalues();
  return eigenvalues.minCoeff() >= -kInformationTolerance * eigenvalues.cwiseAbs().maxCoeff();
}

Eigen::MatrixXd nearest_positive_semidefinite(
    const Eigen::Ref<const Eigen::MatrixXd>& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver{Eigen::MatrixXd(information)};
  const Eigen::VectorXd clipped = solver.eigenvalues().cwiseMax(0.0);
  const Eigen::MatrixXd projected =
      solver.eigenvectors() * clipped.asDiagonal() * solver.eigenvectors().transpose();
  return 0.5 * (projected + projected.transpose());
}

}  // namespace locograph
