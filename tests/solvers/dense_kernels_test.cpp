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

TEST(DenseKernels, ProductsAreRightInEverySizeOfTile) {
  for (const int m : {1, 2, 3, 7, 8, 9, 16, 23, 24, 25, 48, 50, 490}) {
    for (const int n : {1, 2, 3, 4, 5, 6, 7, 8, 9, 31}) {
      for (const int k : {0, 1, 6, 130}) {
        const Eigen::MatrixXd a = random_matrix(m, k, 8), b = random_matrix(n, k, 9);
        const Eigen::MatrixXd before = random_matrix(m, n, 10);
        Eigen::MatrixXd c = before;
        subtract_product(c.data(), m, a.data(), m, b.data(), n, m, n, k);
        EXPECT_LE((c - (before - a * b.transpose())).norm(), 1e-13 * (1 + k) * before.norm());
        c.setConstant(std::nan(""));
        negative_product(c.data(), m, a.data(), m, b.data(), n, m, n, k, false);
        EXPECT_LE((c + a * b.transpose()).norm(), 1e-13 * (1 + k) * before.norm());
        if (n > m) continue;
        const Eigen::MatrixXd square = a * a.topRows(n).transpose();
        c = before;
        subtract_lower_product(c.data(), m, a.data(), m, m, n, k);
        Eigen::MatrixXd difference = c - (before - square);
        EXPECT_LE(difference.triangularView<Eigen::Lower>().toDenseMatrix().norm(),
                  1e-13 * (1 + k) * before.norm());
        c.setConstant(std::nan(""));
        negative_product(c.data(), m, a.data(), m, a.data(), m, m, n, k, true);
        for (int j = 0; j < n; ++j) {
          EXPECT_LE((c.col(j) + square.col(j)).tail(m - j).norm(), 1e-13 * (1 + k) * before.norm());
        }
      }
    }
  }
}

TEST(DenseKernels, BitsDoNotDependOnHowAProductIsCut) {
  const Eigen::MatrixXd a = random_matrix(100, 200, 11), b = random_matrix(40, 200, 12);
  const Eigen::MatrixXd before = random_matrix(100, 40, 13);
  Eigen::MatrixXd whole = before, cut = before;
  subtract_product(whole.data(), 100, a.data(), 100, b.data(), 40, 100, 40, 200);
  for (const auto& [row, rows] : {std::pair(0, 13), {13, 40}, {53, 47}}) {
    for (const auto& [column, columns] : {std::pair(0, 5), {5, 35}}) {
      subtract_product(cut.data() + column * 100 + row, 100, a.data() + row, 100, b.data() + column,
                       40, rows, columns, 200);
    }
  }
  EXPECT_EQ(whole, cut);
}

TEST(DenseKernels, RowsAreDividedByATriangle) {
  for (const int n : {1, 3, 6, 8, 13, 64, 70, 150}) {
    for (const int rows : {1, 8, 21, 60}) {
      Eigen::MatrixXd l = random_matrix(n, n, 14).triangularView<Eigen::Lower>();
      l.diagonal().array() += 10.0 + n;
      const Eigen::MatrixXd b = random_matrix(rows, n, 15);
      Eigen::MatrixXd x = b;
      divide_rows(x.data(), rows, rows, l.data(), n, n);
      EXPECT_LE((x * l.transpose() - b).norm(), 1e-13 * b.norm()) << n << " × " << rows;
    }
  }
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
