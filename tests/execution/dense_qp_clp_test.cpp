// The quadratic programme of the controller against the optimum of Clp, which shares nothing with
// it: a feasible x is the best one exactly if no feasible y has a lower (H x + g)' y.
#include <gtest/gtest.h>
#include <locograph/solvers/dense_qp.h>

#include <ClpSimplex.hpp>
#include <CoinPackedMatrix.hpp>
#include <random>
#include <vector>

namespace locograph {
namespace {

constexpr double kBox = 1e3;  // that all optima are well inside of

/// Of the controller's shape: wrenches that cost a little, a base's force that costs more, cones.
struct Programme {
  Eigen::MatrixXd hessian, rows;
  Eigen::VectorXd gradient, upper;
};

Programme random_programme(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto draw = [&](int count, int size) {
    return Eigen::MatrixXd::NullaryExpr(count, size, [&] { return normal(random); }).eval();
  };
  const int variables = 7 + static_cast<int>(seed % 13), rows = 20 + static_cast<int>(seed % 60);
  const Eigen::MatrixXd by_base = draw(6, variables);
  Programme result;
  result.hessian = by_base.transpose() * by_base;
  result.hessian.diagonal().array() += 1e-2;
  result.gradient = -by_base.transpose() * draw(6, 1);
  result.rows = draw(rows, variables).rowwise().normalized();
  result.upper = draw(rows, 1).cwiseAbs();
  return result;
}

/// The least slope' y over what is feasible, by Clp.
double least_along(const Programme& programme, const Eigen::VectorXd& slope) {
  const int variables = static_cast<int>(slope.size());
  const int rows = static_cast<int>(programme.upper.size());
  CoinPackedMatrix matrix(false, 0, 0);
  matrix.setDimensions(0, variables);
  std::vector<int> all(static_cast<std::size_t>(variables));
  for (int i = 0; i < variables; ++i) all[static_cast<std::size_t>(i)] = i;
  for (int r = 0; r < rows; ++r) {
    const Eigen::VectorXd row = programme.rows.row(r);
    matrix.appendRow(variables, all.data(), row.data());
  }
  const std::vector<double> low(all.size(), -kBox), high(all.size(), kBox),
      none(static_cast<std::size_t>(rows), -COIN_DBL_MAX);
  ClpSimplex simplex;
  simplex.setLogLevel(0);
  simplex.loadProblem(matrix, low.data(), high.data(), slope.data(), none.data(),
                      programme.upper.data());
  simplex.dual();
  EXPECT_TRUE(simplex.isProvenOptimal());
  return simplex.objectiveValue();
}

TEST(DenseQpAgainstClp, FindTheSameOptimum) {
  int active = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const Programme programme = random_programme(seed);
    const int variables = static_cast<int>(programme.gradient.size());
    DenseQp qp(variables, static_cast<int>(programme.upper.size()));
    qp.hessian() = programme.hessian;
    qp.gradient() = programme.gradient;
    for (int r = 0; r < programme.upper.size(); ++r) {
      qp.row(r) = programme.rows.row(r);
      qp.bound(r, -kUnbounded, programme.upper[r]);
    }
    ASSERT_EQ(qp.solve(), QpAnswer::kOptimal) << seed;
    active += static_cast<int>((qp.multipliers().array() != 0.0).count());
    const Eigen::VectorXd& x = qp.solution();
    ASSERT_LT((programme.rows * x - programme.upper).maxCoeff(), 1e-8) << seed;
    ASSERT_LT(x.cwiseAbs().maxCoeff(), kBox) << seed;
    const Eigen::VectorXd slope = programme.hessian * x + programme.gradient;
    EXPECT_NEAR(least_along(programme, slope), slope.dot(x), 1e-6) << seed;
  }
  EXPECT_GT(active, 200) << "most programmes have rows that hold";
}

}  // namespace
}  // namespace locograph
