#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/core/row_kernels.h>

#include <Eigen/Core>
#include <bit>
#include <limits>
#include <random>

namespace locograph {
namespace {

class RowKernelsTest : public testing::TestWithParam<std::string> {
 protected:
  const RowKernels& kernels_ = row_kernels_at(GetParam());
  std::mt19937 random_{4};
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};

  Eigen::MatrixXd matrix(int rows, int columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [this] { return uniform_(random_); });
  }
};
INSTANTIATE_TEST_SUITE_P(Levels, RowKernelsTest, testing::ValuesIn(simd_levels()));

TEST_P(RowKernelsTest, EntriesAreThoseThatAreNotZero) {
  for (int n = 0; n <= 64; ++n) {
    std::vector<double> row(static_cast<std::size_t>(n));
    std::uint64_t expected = 0;
    for (int c = 0; c < n; ++c) {
      const unsigned draw = random_() % 5;
      row[c] = draw == 0   ? uniform_(random_)
               : draw == 1 ? std::numeric_limits<double>::quiet_NaN()
               : draw == 2 ? -0.0
                           : 0.0;
      if (draw < 2) expected |= std::uint64_t{1} << c;
    }
    // What lies beyond is nobody's.
    EXPECT_EQ(kernels_.entries(row.data(), n), expected) << n;
  }
}

TEST_P(RowKernelsTest, ProductsAreThoseOfEigen) {
  constexpr int kWidth = 21;
  for (int rows = 1; rows <= kMostRowsTogether; ++rows) {
    for (int n = 1; n <= 19; ++n) {
      const Eigen::MatrixXd left = matrix(n, rows), right = matrix(kWidth, rows);
      const Eigen::VectorXd weight = matrix(rows, 1);
      const std::vector<int> columns = {0, 3, 4, kWidth - 1};
      Eigen::MatrixXd sum = matrix(n + 2, kWidth), expected = sum;
      for (const int c : columns) {
        expected.col(c).head(n) += left * weight.cwiseProduct(right.row(c).transpose()).eval();
      }
      std::vector<const double*> lefts, rights;
      for (int r = 0; r < rows; ++r) {
        lefts.push_back(left.col(r).data());
        rights.push_back(right.col(r).data());
      }
      kernels_.add_products(rows, lefts.data(), n, rights.data(), weight.data(), columns.data(),
                            static_cast<int>(columns.size()), sum.data(), n + 2);
      EXPECT_LT((sum - expected).cwiseAbs().maxCoeff(), 1e-14) << rows << " " << n;
      EXPECT_EQ(sum.bottomRows(2), expected.bottomRows(2));
    }
  }
}

TEST(RowKernels, ALevelThatThereIsNotIsAnError) { EXPECT_THROW(row_kernels_at("v1"), Error); }

}  // namespace
}  // namespace locograph
