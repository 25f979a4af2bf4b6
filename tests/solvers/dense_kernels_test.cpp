#include <gtest/gtest.h>
#include <locograph/solvers/dense_kernels.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace locograph {
namespace {

using Strided = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

Eigen::MatrixXd random_matrix(int rows, int columns, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&](Eigen::Index) { return uniform(engine); });
}

TEST(DenseKernels, CholeskyOfAPanelFactorsItsTopAndDividesTheRest) {
  for (const int columns : {1, 2, 3, 7, 8, 9, 16, 17, 30, 61}) {
    for (const int below : {0, 1, 5, 40}) {
      const int rows = columns + below, ld = rows + 3;
      const Eigen::MatrixXd a = random_matrix(columns, columns, 1);
      Eigen::MatrixXd whole(rows, columns);
      whole.topRows(columns) = a * a.transpose() + Eigen::MatrixXd::Identity(columns, columns);
      whole.bottomRows(below) = random_matrix(below, columns, 2);
      Eigen::MatrixXd storage = Eigen::MatrixXd::Constant(ld, columns, 77.0);
      Strided panel(storage.data(), rows, columns, Eigen::OuterStride<>(ld));
      panel = whole;
      panel.topRows(columns).triangularView<Eigen::StrictlyUpper>().setConstant(1e30);
      ASSERT_EQ(cholesky_in_place(storage.data(), ld, rows, columns), -1);
      const Eigen::MatrixXd l = panel.topRows(columns).triangularView<Eigen::Lower>();
      EXPECT_LE((l * l.transpose() - whole.topRows(columns)).norm(), 1e-13 * whole.norm());
      EXPECT_LE((panel.bottomRows(below) * l.transpose() - whole.bottomRows(below)).norm(),
                1e-12 * whole.norm());
      EXPECT_EQ(storage.bottomRows(3), Eigen::MatrixXd::Constant(3, columns, 77.0));
    }
  }
}

TEST(DenseKernels, CholeskyNamesTheFirstBadColumn) {
  for (const int bad : {0, 3, 7, 8, 12, 19}) {
    Eigen::MatrixXd a = 2.0 * Eigen::MatrixXd::Identity(20, 20);
    a(bad, bad) = -1.0;
    EXPECT_EQ(cholesky_in_place(a.data(), 20, 20, 20), bad);
    a = 2.0 * Eigen::MatrixXd::Identity(20, 20);
    a(bad, bad) = std::nan("");
    EXPECT_EQ(cholesky_in_place(a.data(), 20, 20, 20), bad);
  }
}

TEST(DenseKernels, ProductIsSubtracted) {
  const Eigen::MatrixXd a = random_matrix(13, 5, 3), b = random_matrix(9, 5, 4);
  Eigen::MatrixXd c = random_matrix(13, 9, 5);
  const Eigen::MatrixXd expected = c - a * b.transpose();
  subtract_product(c.data(), 13, a.data(), 13, b.data(), 9, 13, 9, 5);
  EXPECT_LE((c - expected).norm(), 1e-14 * expected.norm());
}

TEST(DenseKernels, TriangularSystemsAreSolvedBothWays) {
  for (const int n : {1, 2, 6, 31}) {
    Eigen::MatrixXd l = random_matrix(n, n, 6).triangularView<Eigen::Lower>();
    l.diagonal().array() += 5.0;
    const Eigen::VectorXd b = random_matrix(n, 1, 7);
    Eigen::VectorXd x = b;
    solve_lower(l.data(), n, n, x.data());
    EXPECT_LE((l * x - b).norm(), 1e-13);
    x = b;
    solve_lower_transposed(l.data(), n, n, x.data());
    EXPECT_LE((l.transpose() * x - b).norm(), 1e-13);
  }
}

}  // namespace
}  // namespace locograph
