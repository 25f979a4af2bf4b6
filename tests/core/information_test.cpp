#include <gtest/gtest.h>
#include <locograph/core/information.h>

#include <Eigen/Eigenvalues>
#include <random>

namespace locograph {
namespace {

Eigen::MatrixXd random_symmetric(int n, std::mt19937& engine) {
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd a =
      Eigen::MatrixXd::NullaryExpr(n, n, [&](Eigen::Index) { return normal(engine); });
  return a + a.transpose();
}

double smallest_eigenvalue(const Eigen::MatrixXd& m) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m).eigenvalues().minCoeff();
}

TEST(Information, IsPositiveSemidefiniteExactlyWhenItsEigenvaluesAre) {
  std::mt19937 engine(3);
  int refused = 0;
  for (int i = 0; i < 500; ++i) {
    const int n = 1 + i % 20;
    const Eigen::MatrixXd m =
        random_symmetric(n, engine) + (i % 3) * std::sqrt(n) * Eigen::MatrixXd::Identity(n, n);
    EXPECT_EQ(is_positive_semidefinite(m), smallest_eigenvalue(m) >= 0.0);
    refused += !is_positive_semidefinite(m);
  }
  EXPECT_GT(refused, 100);
  EXPECT_LT(refused, 480);
}

TEST(Information, OfLowRankIsPositiveSemidefinite) {
  std::mt19937 engine(4);
  for (int n = 2; n <= 18; ++n) {
    const Eigen::MatrixXd factor = random_symmetric(n, engine).leftCols(n / 2);
    EXPECT_TRUE(is_positive_semidefinite(factor * factor.transpose())) << n;
    EXPECT_TRUE(is_positive_semidefinite(Eigen::MatrixXd::Zero(n, n))) << n;
  }
}

TEST(Information, WithANegativeEigenvalueAboveRoundingIsRefused) {
  Eigen::Matrix3d m = Eigen::Vector3d(1.0, 1.0, -1e-9).asDiagonal();
  EXPECT_FALSE(is_positive_semidefinite(m));
  m(2, 2) = -1e-15;
  EXPECT_TRUE(is_positive_semidefinite(m));
}

TEST(Information, IsProjectedToTheNearestSemidefiniteMatrix) {
  std::mt19937 engine(5);
  for (int i = 0; i < 200; ++i) {
    const int n = 1 + i % 8;
    const Eigen::MatrixXd m = random_symmetric(n, engine);
    const Eigen::MatrixXd nearest = nearest_positive_semidefinite(m);
    EXPECT_EQ(nearest, nearest.transpose());
    EXPECT_TRUE(is_positive_semidefinite(nearest));
    // Higham 1988: the distance is the norm of the negative eigenvalues, and no less is possible.
    const Eigen::VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m).eigenvalues();
    EXPECT_NEAR((nearest - m).norm(), eigenvalues.cwiseMin(0.0).norm(), 1e-12 * m.norm());
    // The residual is negative semi-definite and orthogonal to the projection.
    EXPECT_NEAR((nearest - m).cwiseProduct(nearest).sum(), 0.0, 1e-11 * m.squaredNorm());
    EXPECT_GE(smallest_eigenvalue(nearest - m), -1e-12 * m.norm());
  }
}

TEST(Information, ThatIsSemidefiniteIsItsOwnProjection) {
  std::mt19937 engine(6);
  const Eigen::MatrixXd a = random_symmetric(6, engine), m = a * a.transpose();
  EXPECT_LE((nearest_positive_semidefinite(m) - m).norm(), 1e-13 * m.norm());
}

TEST(Information, IsSymmetricUpToRounding) {
  Eigen::Matrix2d m;
  m << 1.0, 0.5, 0.5, 1.0;
  EXPECT_TRUE(is_symmetric(m));
  m(0, 1) += 1e-6;
  EXPECT_FALSE(is_symmetric(m));
  EXPECT_FALSE(is_symmetric(Eigen::MatrixXd::Zero(2, 3)));
}

}  // namespace
}  // namespace locograph
