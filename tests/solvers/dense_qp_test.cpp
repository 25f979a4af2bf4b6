#include <gtest/gtest.h>
#include <locograph/solvers/dense_qp.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <random>

#include "common/allocation_counter.h"

namespace locograph {
namespace {

Eigen::VectorXd random_vector(std::mt19937& random, int size) {
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random); });
}

/// A programme with a point inside: `tight` of its rows hold there exactly.
struct RandomProgramme {
  DenseQp qp;
  Eigen::MatrixXd hessian, rows;
  Eigen::VectorXd gradient, lower, upper;

  RandomProgramme(unsigned seed, int variables, int count, int equalities)
      : qp(variables, count),
        rows(count, variables),
        lower(Eigen::VectorXd::Constant(count, -kUnbounded)),
        upper(Eigen::VectorXd::Constant(count, kUnbounded)) {
    std::mt19937 random(seed);
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(
        variables, variables, [&] { return std::normal_distribution<double>()(random); });
    hessian = root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(variables, variables);
    gradient = 5.0 * random_vector(random, variables);
    const Eigen::VectorXd inside = random_vector(random, variables);
    std::uniform_real_distribution<double> room(0.0, 1.0);
    for (int i = 0; i < count; ++i) {
      rows.row(i) = random_vector(random, variables).transpose().normalized();
      const double value = rows.row(i).dot(inside);
      if (i < equalities) {
        lower[i] = upper[i] = value;
      } else if (i % 3 == 0) {
        lower[i] = value - (i % 2 == 0 ? 0.0 : room(random));
      } else if (i % 3 == 1) {
        upper[i] = value + room(random);
      } else {
        lower[i] = value - room(random);
        upper[i] = value + room(random);
      }
    }
    load();
  }

  void load() {
    qp.hessian() = hessian;
    qp.gradient() = gradient;
    for (int i = 0; i < rows.rows(); ++i) {
      qp.row(i) = rows.row(i);
      qp.bound(i, lower[i], upper[i]);
    }
  }

  /// Stationary, within bounds, multipliers of the right sign and of active rows only.
  void expect_optimal() const {
    const Eigen::VectorXd &x = qp.solution(), &y = qp.multipliers();
    EXPECT_LT((hessian * x + gradient - rows.transpose() * y).cwiseAbs().maxCoeff(), 1e-7);
    for (int i = 0; i < rows.rows(); ++i) {
      const double value = rows.row(i).dot(x);
      EXPECT_GE(value, lower[i] - 1e-8);
      EXPECT_LE(value, upper[i] + 1e-8);
      if (lower[i] == upper[i]) continue;
      if (y[i] > 0.0) {
        EXPECT_NEAR(value, lower[i], 1e-8);
      }
      if (y[i] < 0.0) {
        EXPECT_NEAR(value, upper[i], 1e-8);
      }
    }
  }
};

TEST(DenseQp, AnswersHaveMultipliersThatProveThem) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const int variables = 2 + static_cast<int>(seed % 30);
    RandomProgramme programme(seed, variables, 3 * variables, static_cast<int>(seed % 3));
    ASSERT_EQ(programme.qp.solve(), QpAnswer::kOptimal) << seed;
    programme.expect_optimal();
  }
}

TEST(DenseQp, FromTheLastSolutionItGetsToTheSameInFewerSteps) {
  int cold = 0, warm = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    RandomProgramme programme(seed, 20, 60, 3);
    ASSERT_EQ(programme.qp.solve(), QpAnswer::kOptimal);
    programme.gradient *= 1.001;
    programme.load();
    ASSERT_EQ(programme.qp.solve(), QpAnswer::kOptimal);
    const Eigen::VectorXd x = programme.qp.solution();
    warm += programme.qp.steps();
    programme.qp.forget();
    ASSERT_EQ(programme.qp.solve(), QpAnswer::kOptimal);
    cold += programme.qp.steps();
    EXPECT_LT((programme.qp.solution() - x).cwiseAbs().maxCoeff(), 1e-8);
  }
  EXPECT_LT(warm, cold);
}

TEST(DenseQp, EqualitiesThatSayTheSameAreOne) {
  DenseQp qp(2, 3);
  qp.hessian().setIdentity();
  for (const int i : {0, 1}) {
    qp.row(i) << 1.0, 1.0;
    qp.bound(i, 2.0, 2.0);
  }
  qp.row(2) << 1.0, 0.0;
  qp.bound(2, -kUnbounded, 0.5);
  ASSERT_EQ(qp.solve(), QpAnswer::kOptimal);
  EXPECT_NEAR(qp.solution()[0], 0.5, 1e-12);
  EXPECT_NEAR(qp.solution()[1], 1.5, 1e-12);
}

TEST(DenseQp, TellsThatNothingIsWithinAllBounds) {
  DenseQp qp(2, 2);
  qp.hessian().setIdentity();
  for (const int i : {0, 1}) qp.row(i) << 1.0, 1.0;
  qp.bound(0, 1.0, kUnbounded);
  qp.bound(1, -kUnbounded, 0.0);
  EXPECT_EQ(qp.solve(), QpAnswer::kInfeasible);
  qp.bound(0, 1.0, 1.0);
  qp.bound(1, 2.0, 2.0);
  EXPECT_EQ(qp.solve(), QpAnswer::kInfeasible);
  qp.bound(1, 0.0, 3.0);
  EXPECT_EQ(qp.solve(), QpAnswer::kOptimal);
}

TEST(DenseQp, RefusesACostThatHasNoLeast) {
  DenseQp qp(1, 0);
  qp.hessian()(0, 0) = -1.0;
  EXPECT_EQ(qp.solve(), QpAnswer::kUnsolved);
}

TEST(DenseQp, DoesNotAllocate) {
  RandomProgramme programme(1, 24, 80, 6);
  const long before = test::allocation_count();
  ASSERT_EQ(programme.qp.solve(), QpAnswer::kOptimal);
  EXPECT_EQ(test::allocation_count(), before);
}

}  // namespace
}  // namespace locograph
