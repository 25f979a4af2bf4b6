#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/solvers/pcg_solver.h>
#include <locograph/types/slam3d/edges.h>

#include <cstring>
#include <limits>
#include <random>

#include "common/allocation_counter.h"
#include "solvers/random_system.h"

namespace locograph::test {
namespace {

std::vector<RandomSystem> systems() {
  std::vector<RandomSystem> all;
  for (const int d : {1, 3, 6, 9}) {
    all.emplace_back(grid_pairs(12), std::vector<int>(144, d), 1);
  }
  std::vector<int> mixed;
  for (int i = 0; i < 144; ++i) mixed.push_back(1 + i * 7 % 9);
  all.emplace_back(random_pairs(144, 500, 2), mixed, 2);
  all.emplace_back(Pairs{}, std::vector<int>{4}, 3);
  return all;
}

TEST(PcgSolver, IsAsExactAsAsked) {
  for (const RandomSystem& a : systems()) {
    const Eigen::VectorXd& expected = a.expected();
    double last_error = 1.0;
    for (const double tolerance : {1e-3, 1e-8, 1e-14}) {
      PcgOptions options;
      options.relative_tolerance = tolerance;
      PcgSolver solver(options);
      solver.analyse(a.pattern);
      ASSERT_TRUE(solver.factorise(a.values.data(), a.damping.data()));
      Eigen::VectorXd x(a.pattern.scalar_size());
      solver.solve(a.right_hand_side.data(), x.data());
      EXPECT_LE(solver.relative_residual(), tolerance);
      EXPECT_LE((x - expected).norm(), std::max(10.0 * tolerance, 1e-12) * expected.norm());
      EXPECT_LE((x - expected).norm(), last_error);
      last_error = std::max((x - expected).norm(), 1e-12);
      Eigen::VectorXd in_place =
          Eigen::Map<const Eigen::VectorXd>(a.right_hand_side.data(), x.size());
      solver.solve(in_place.data(), in_place.data());
      EXPECT_EQ(in_place, x);
    }
  }
}

TEST(PcgSolver, StopsAtTheIterationsAllowedWithAnIterateOrthogonalToItsResidual) {
  const RandomSystem a(grid_pairs(12), std::vector<int>(144, 3), 1);
  PcgOptions options;
  options.max_iterations = 3;
  PcgSolver solver(options);
  solver.analyse(a.pattern);
  ASSERT_TRUE(solver.factorise(a.values.data(), a.damping.data()));
  Eigen::VectorXd x(a.pattern.scalar_size());
  solver.solve(a.right_hand_side.data(), x.data());
  EXPECT_EQ(solver.iterations(), 3);
  EXPECT_GT(solver.relative_residual(), options.relative_tolerance);
  const Eigen::Map<const Eigen::VectorXd> b(a.right_hand_side.data(), x.size());
  // What the decrease that Levenberg-Marquardt predicts rests on.
  EXPECT_NEAR(x.dot(b - a.matrix * x), 0.0, 1e-12 * x.norm() * b.norm());
  EXPECT_GT(x.dot(b), 0.0);
}

TEST(PcgSolver, GivesTheSameBitsOnTwoAndThreeThreads) {
  for (const RandomSystem& a : systems()) {
    std::vector<double> alone(a.right_hand_side.size()), together(alone.size());
    for (const int count : {1, 2, 3}) {
      ThreadPool threads(count);
      PcgSolver solver;
      solver.use_threads(&threads);
      solver.analyse(a.pattern);
      ASSERT_TRUE(solver.factorise(a.values.data(), a.damping.data()));
      solver.solve(a.right_hand_side.data(), (count == 1 ? alone : together).data());
      if (count == 1) continue;
      EXPECT_EQ(std::memcmp(alone.data(), together.data(), alone.size() * sizeof(double)), 0);
    }
  }
}

TEST(PcgSolver, FactorisesAndSolvesWithoutAllocating) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  for (const RandomSystem& a : systems()) {
    std::vector<double> x(a.right_hand_side.size());
    PcgSolver solver;
    solver.analyse(a.pattern);
    const long before = allocation_count();
    solver.analyse(a.pattern);
    const bool good = solver.factorise(a.values.data(), a.damping.data());
    solver.solve(a.right_hand_side.data(), x.data());
    const long after = allocation_count();
    EXPECT_TRUE(good);
    EXPECT_EQ(after - before, 0);
  }
}

TEST(PcgSolver, NamesADiagonalBlockThatIsNotPositiveDefinite) {
  const RandomSystem good(grid_pairs(12), std::vector<int>(144, 3), 1);
  PcgSolver solver;
  solver.analyse(good.pattern);
  for (const int bad : {0, 77, 143}) {
    for (const double value : {-1e6, std::numeric_limits<double>::quiet_NaN()}) {
      RandomSystem a = good;
      a.for_each_block([&](int r, int c, auto block) {
        if (r == bad && c == bad) block(2, 2) = value;
      });
      EXPECT_FALSE(solver.factorise(a.values.data(), a.damping.data()));
      EXPECT_EQ(solver.failed_row(), bad);
    }
  }
  EXPECT_TRUE(solver.factorise(good.values.data(), good.damping.data()));
  EXPECT_EQ(solver.failed_row(), -1);
}

TEST(PcgSolver, EndsOnAMatrixThatIsIndefiniteBetweenItsBlocks) {
  RandomSystem a(Pairs{{0, 1}}, {1, 1}, 1);
  a.damping = {0.0, 0.0};
  a.for_each_block([](int r, int c, auto block) { block(0, 0) = r == c ? 1.0 : 3.0; });
  PcgSolver solver;
  solver.analyse(a.pattern);
  ASSERT_TRUE(solver.factorise(a.values.data(), a.damping.data()));
  double x[2];
  const double b[2] = {1.0, -1.0};
  solver.solve(b, x);
  EXPECT_TRUE(std::isfinite(x[0]) && std::isfinite(x[1]));
}

TEST(PcgSolver, SolvesAZeroRightHandSideByZero) {
  const RandomSystem a(grid_pairs(4), std::vector<int>(16, 3), 1);
  PcgSolver solver;
  solver.analyse(a.pattern);
  ASSERT_TRUE(solver.factorise(a.values.data(), a.damping.data()));
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(a.pattern.scalar_size());
  Eigen::VectorXd x = Eigen::VectorXd::Ones(zero.size());
  solver.solve(zero.data(), x.data());
  EXPECT_EQ(x, zero);
  EXPECT_EQ(solver.iterations(), 0);
}

TEST(PcgOptions, OutOfRangeAreRefused) {
  PcgOptions options;
  for (const double tolerance : {0.0, 1.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    options.relative_tolerance = tolerance;
    EXPECT_THROW(PcgSolver{options}, Error) << tolerance;
  }
  options = {};
  options.max_iterations = 0;
  EXPECT_THROW(PcgSolver{options}, Error);
}

/// Poses on a grid, each measured from its left and lower neighbours; perturbed.
Graph grid_of_poses(int side) {
  std::mt19937 engine(1);
  std::normal_distribution<double> normal;
  const auto noise = [&](double size) -> Eigen::Vector3d {
    return size * Eigen::Vector3d(normal(engine), normal(engine), normal(engine));
  };
  Graph graph;
  std::vector<VertexId<VertexSE3>> poses;
  std::vector<SE3<double>> truth;
  for (int i = 0; i < side * side; ++i) {
    truth.emplace_back(Eigen::Vector3d(i % side, i / side, 0.0),
                       quaternion_exp(noise(0.5)).normalized());
    const SE3<double> start(truth[i].translation() + noise(0.05),
                            (truth[i].rotation() * quaternion_exp(noise(0.02))).normalized());
    poses.push_back(graph.add_vertex(i, VertexSE3(start)));
  }
  const auto measure = [&](int a, int b) {
    EdgeSE3 edge;
    edge.measurement = truth[a].inverse() * truth[b] *
                       SE3<double>(noise(0.01), quaternion_exp(noise(0.005)).normalized());
    edge.information = 100.0 * Eigen::Matrix<double, 6, 6>::Identity();
    graph.add_edge(edge, poses[a], poses[b]);
  };
  for (int i = 0; i < side * side; ++i) {
    if (i % side > 0) measure(i - 1, i);
    if (i >= side) measure(i - side, i);
  }
  graph.set_fixed(poses[0], true);
  return graph;
}

TEST(PcgSolver, OptimisesAGridOfPosesToWhereTheFactorisationEnds) {
  OptimiserOptions options;
  Graph direct = grid_of_poses(25), iterative = grid_of_poses(25);
  const OptimiserResult expected = optimise(direct, options, *make_linear_solver("block-cholesky"));
  const OptimiserResult result = optimise(iterative, options, *make_linear_solver("pcg"));
  EXPECT_TRUE(expected.converged);
  EXPECT_TRUE(result.converged) << result.reason_text();
  EXPECT_NEAR(result.final.chi2, expected.final.chi2, 1e-6 * expected.final.chi2);
  EXPECT_LT(result.final.chi2, 0.5 * result.initial.chi2);
}

}  // namespace
}  // namespace locograph::test
