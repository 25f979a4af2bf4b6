#include <gtest/gtest.h>
#include <locograph/common/simd_level.h>
#include <locograph/solvers/kernels.h>

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

/// Every test runs at every level that this machine has.
class DenseKernelsTest : public testing::TestWithParam<std::string> {
 protected:
  const DenseKernels& dense_ = kernels_at(GetParam()).dense;
};
INSTANTIATE_TEST_SUITE_P(Levels, DenseKernelsTest, testing::ValuesIn(simd_levels()),
                         [](const auto& info) { return info.param; });

TEST_P(DenseKernelsTest, CholeskyOfAPanelFactorsItsTopAndDividesTheRest) {
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
      ASSERT_EQ(dense_.cholesky_in_place(storage.data(), ld, rows, columns), -1);
      const Eigen::MatrixXd l = panel.topRows(columns).triangularView<Eigen::Lower>();
      EXPECT_LE((l * l.transpose() - whole.topRows(columns)).norm(), 1e-13 * whole.norm());
      EXPECT_LE((panel.bottomRows(below) * l.transpose() - whole.bottomRows(below)).norm(),
                1e-12 * whole.norm());
      EXPECT_EQ(storage.bottomRows(3), Eigen::MatrixXd::Constant(3, columns, 77.0));
    }
  }
}

TEST_P(DenseKernelsTest, CholeskyNamesTheFirstBadColumn) {
  for (const int bad : {0, 3, 7, 8, 12, 19}) {
    Eigen::MatrixXd a = 2.0 * Eigen::MatrixXd::Identity(20, 20);
    a(bad, bad) = -1.0;
    EXPECT_EQ(dense_.cholesky_in_place(a.data(), 20, 20, 20), bad);
    a = 2.0 * Eigen::MatrixXd::Identity(20, 20);
    a(bad, bad) = std::nan("");
    EXPECT_EQ(dense_.cholesky_in_place(a.data(), 20, 20, 20), bad);
  }
}

TEST_P(DenseKernelsTest, ProductIsSubtracted) {
  const Eigen::MatrixXd a = random_matrix(13, 5, 3), b = random_matrix(9, 5, 4);
  Eigen::MatrixXd c = random_matrix(13, 9, 5);
  const Eigen::MatrixXd expected = c - a * b.transpose();
  dense_.subtract_product(c.data(), 13, a.data(), 13, b.data(), 9, 13, 9, 5);
  EXPECT_LE((c - expected).norm(), 1e-14 * expected.norm());
}

TEST_P(DenseKernelsTest, ProductsAreRightInEverySizeOfTile) {
  for (const int m : {1, 2, 3, 7, 8, 9, 16, 23, 24, 25, 48, 50, 490}) {
    for (const int n : {1, 2, 3, 4, 5, 6, 7, 8, 9, 31}) {
      for (const int k : {0, 1, 6, 130}) {
        const Eigen::MatrixXd a = random_matrix(m, k, 8), b = random_matrix(n, k, 9);
        const Eigen::MatrixXd before = random_matrix(m, n, 10);
        Eigen::MatrixXd c = before;
        dense_.subtract_product(c.data(), m, a.data(), m, b.data(), n, m, n, k);
        EXPECT_LE((c - (before - a * b.transpose())).norm(), 1e-13 * (1 + k) * before.norm());
        c.setConstant(std::nan(""));
        dense_.negative_product(c.data(), m, a.data(), m, b.data(), n, m, n, k, false);
        EXPECT_LE((c + a * b.transpose()).norm(), 1e-13 * (1 + k) * before.norm());
        if (n > m) continue;
        const Eigen::MatrixXd square = a * a.topRows(n).transpose();
        c = before;
        dense_.subtract_lower_product(c.data(), m, a.data(), m, m, n, k);
        Eigen::MatrixXd difference = c - (before - square);
        EXPECT_LE(difference.triangularView<Eigen::Lower>().toDenseMatrix().norm(),
                  1e-13 * (1 + k) * before.norm());
        c.setConstant(std::nan(""));
        dense_.negative_product(c.data(), m, a.data(), m, a.data(), m, m, n, k, true);
        for (int j = 0; j < n; ++j) {
          EXPECT_LE((c.col(j) + square.col(j)).tail(m - j).norm(), 1e-13 * (1 + k) * before.norm());
        }
      }
    }
  }
}

/// Whether a product is subtracted without being rounded first: (1 + 2⁻³⁰)² is 1 + 2⁻²⁹ + 2⁻⁶⁰.
bool fuses(const DenseKernels& dense) {
  const double a = 1.0 + 0x1p-30;
  double c = 1.0 + 0x1p-29;
  dense.subtract_product(&c, 1, &a, 1, &a, 1, 1, 1, 1);
  return c != 0.0;
}

/// c − a b as the level does it, whatever this file is compiled with.
double minus_product(double c, double a, double b, bool fused) {
  if (fused) return std::fma(-a, b, c);
  const volatile double product = a * b;
  return c - product;
}

TEST_P(DenseKernelsTest, EveryElementOfAProductIsTheSameSequenceOfOperations) {
  const bool fused = fuses(dense_);
  if (GetParam() != "portable") {
    EXPECT_EQ(fused, GetParam() != "v2");
  }
  const Eigen::MatrixXd a = random_matrix(61, 130, 21), b = random_matrix(37, 130, 22);
  const Eigen::MatrixXd before = random_matrix(61, 37, 23);
  Eigen::MatrixXd expected = before, negative = Eigen::MatrixXd::Zero(61, 37);
  for (int p = 0; p < 130; ++p) {
    for (int j = 0; j < 37; ++j) {
      for (int i = 0; i < 61; ++i) {
        expected(i, j) = minus_product(expected(i, j), a(i, p), b(j, p), fused);
        negative(i, j) = minus_product(negative(i, j), a(i, p), b(j, p), fused);
      }
    }
  }
  // Pieces of all sizes: whole tiles, one register, a part of a register.
  for (const int rows : {1, 2, 3, 4, 5, 7, 8, 9, 15, 24, 29, 61}) {
    for (const int columns : {1, 2, 3, 5, 7, 8, 37}) {
      Eigen::MatrixXd c = before, d = before;
      for (int i = 0; i < 61; i += rows) {
        for (int j = 0; j < 37; j += columns) {
          const int m = std::min(rows, 61 - i), n = std::min(columns, 37 - j);
          dense_.subtract_product(&c(i, j), 61, &a(i, 0), 61, &b(j, 0), 37, m, n, 130);
          dense_.negative_product(&d(i, j), 61, &a(i, 0), 61, &b(j, 0), 37, m, n, 130, false);
        }
      }
      ASSERT_EQ(c, expected) << rows << " × " << columns;
      ASSERT_EQ(d, negative) << rows << " × " << columns;
    }
  }
}

TEST_P(DenseKernelsTest, BitsDoNotDependOnHowAProductIsCut) {
  const Eigen::MatrixXd a = random_matrix(100, 200, 11), b = random_matrix(40, 200, 12);
  const Eigen::MatrixXd before = random_matrix(100, 40, 13);
  Eigen::MatrixXd whole = before, cut = before;
  dense_.subtract_product(whole.data(), 100, a.data(), 100, b.data(), 40, 100, 40, 200);
  for (const auto& [row, rows] : {std::pair(0, 13), {13, 40}, {53, 47}}) {
    for (const auto& [column, columns] : {std::pair(0, 5), {5, 35}}) {
      dense_.subtract_product(cut.data() + column * 100 + row, 100, a.data() + row, 100,
                              b.data() + column, 40, rows, columns, 200);
    }
  }
  EXPECT_EQ(whole, cut);
}

TEST_P(DenseKernelsTest, RowsAreDividedByATriangle) {
  for (const int n : {1, 3, 6, 8, 13, 64, 70, 150}) {
    for (const int rows : {1, 8, 21, 60}) {
      Eigen::MatrixXd l = random_matrix(n, n, 14).triangularView<Eigen::Lower>();
      l.diagonal().array() += 10.0 + n;
      const Eigen::MatrixXd b = random_matrix(rows, n, 15);
      Eigen::MatrixXd x = b;
      dense_.divide_rows(x.data(), rows, rows, l.data(), n, n);
      EXPECT_LE((x * l.transpose() - b).norm(), 1e-13 * b.norm()) << n << " × " << rows;
    }
  }
}

TEST_P(DenseKernelsTest, BitsDoNotDependOnHowRowsToDivideAreCut) {
  for (const int n : {1, 5, 8, 61, 70}) {
    Eigen::MatrixXd l = random_matrix(n, n, 16).triangularView<Eigen::Lower>();
    l.diagonal().array() += 10.0 + n;
    const Eigen::MatrixXd before = random_matrix(61, n, 17);
    Eigen::MatrixXd whole = before;
    dense_.divide_rows(whole.data(), 61, 61, l.data(), n, n);
    for (const int rows : {1, 2, 3, 5, 8, 11, 24, 27}) {
      Eigen::MatrixXd cut = before;
      for (int i = 0; i < 61; i += rows) {
        dense_.divide_rows(cut.data() + i, 61, std::min(rows, 61 - i), l.data(), n, n);
      }
      ASSERT_EQ(whole, cut) << n << " columns, " << rows << " rows at a time";
    }
  }
}

TEST_P(DenseKernelsTest, BitsUnderAPanelDoNotDependOnItsHeight) {
  for (const int columns : {1, 3, 8, 13, 70}) {
    const Eigen::MatrixXd a = random_matrix(columns, columns, 18);
    Eigen::MatrixXd whole(columns + 61, columns);
    whole.topRows(columns) = a * a.transpose() + Eigen::MatrixXd::Identity(columns, columns);
    whole.bottomRows(61) = random_matrix(61, columns, 19);
    const Eigen::MatrixXd before = whole;
    const int ld = columns + 61;
    ASSERT_EQ(dense_.cholesky_in_place(whole.data(), ld, ld, columns), -1);
    for (const int below : {0, 1, 2, 3, 5, 8, 11, 24, 27}) {
      Eigen::MatrixXd part = before.topRows(columns + below);
      ASSERT_EQ(dense_.cholesky_in_place(part.data(), columns + below, columns + below, columns),
                -1);
      for (int j = 0; j < columns; ++j) {
        ASSERT_EQ(part.col(j).tail(columns + below - j),
                  whole.col(j).segment(j, columns + below - j))
            << below << " rows under column " << j << " of " << columns;
      }
    }
  }
}

TEST_P(DenseKernelsTest, TriangularSystemsAreSolvedBothWays) {
  for (const int n : {1, 2, 6, 31}) {
    Eigen::MatrixXd l = random_matrix(n, n, 6).triangularView<Eigen::Lower>();
    l.diagonal().array() += 5.0;
    const Eigen::VectorXd b = random_matrix(n, 1, 7);
    Eigen::VectorXd x = b;
    dense_.solve_lower(l.data(), n, n, x.data());
    EXPECT_LE((l * x - b).norm(), 1e-13);
    x = b;
    dense_.solve_lower_transposed(l.data(), n, n, x.data());
    EXPECT_LE((l.transpose() * x - b).norm(), 1e-13);
  }
}

}  // namespace
}  // namespace locograph
