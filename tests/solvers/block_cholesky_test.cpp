#include <gtest/gtest.h>
#include <locograph/solvers/block_cholesky.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "common/allocation_counter.h"
#include "solvers/random_system.h"

namespace locograph::test {
namespace {

/// Blocks on a grid with random sizes or all of one, large enough for many items of work, shared
/// fronts and both orders. No dense matrix: the residual is the judge.
struct GridSystem {
  BlockPattern pattern;
  std::vector<double> values, damping, right_hand_side;

  GridSystem(const Pairs& pairs, const std::vector<int>& dimension, unsigned seed)
      : pattern(make_pattern(pairs, dimension)) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    values.resize(pattern.values());
    for (double& v : values) v = uniform(engine);
    std::vector<double> weight(pattern.scalar_size(), 1.0);
    for (int c = 0; c < pattern.size(); ++c) {
      for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
        const int r = pattern.row[k], rows = pattern.dimension[r];
        double* block = values.data() + pattern.value_offset[k];
        for (int j = 0; j < pattern.dimension[c]; ++j) {
          for (int i = 0; i < rows; ++i) {
            if (r == c && i > j) block[j * rows + i] = block[i * rows + j];
            weight[pattern.scalar_begin[r] + i] += std::abs(block[j * rows + i]);
            if (r != c) weight[pattern.scalar_begin[c] + j] += std::abs(block[j * rows + i]);
          }
        }
      }
    }
    // Diagonally dominant, the diagonal itself being at most 1 in size: positive definite.
    for (double& w : weight) damping.push_back(w);
    for (int i = 0; i < pattern.scalar_size(); ++i) right_hand_side.push_back(uniform(engine));
  }

  double* diagonal_block(int c) {
    return values.data() + pattern.value_offset[pattern.column_begin[c + 1] - 1];
  }
  double residual(const std::vector<double>& x) const {
    std::vector<double> rest = right_hand_side;
    for (std::size_t i = 0; i < x.size(); ++i) rest[i] -= damping[i] * x[i];
    for (int c = 0; c < pattern.size(); ++c) {
      for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
        const int r = pattern.row[k], rows = pattern.dimension[r];
        for (int j = 0; j < pattern.dimension[c]; ++j) {
          for (int i = 0; i < rows; ++i) {
            const double v = values[pattern.value_offset[k] + j * rows + i];
            const int row = pattern.scalar_begin[r] + i, column = pattern.scalar_begin[c] + j;
            rest[row] -= v * x[column];
            if (r != c) rest[column] -= v * x[row];
          }
        }
      }
    }
    double largest = 0.0;
    for (const double v : rest) largest = std::max(largest, std::abs(v));
    return largest;
  }
};

std::vector<int> sizes(int count, int dimension) {
  std::mt19937 engine(5);
  std::vector<int> result(count, dimension);
  for (int& d : result) {
    if (dimension == 0) d = 1 + static_cast<int>(engine() % 9);
  }
  return result;
}

/// side³ blocks with their six neighbours: separators large enough for shared fronts.
Pairs cube_pairs(int side) {
  Pairs pairs;
  const auto at = [&](int x, int y, int z) { return (z * side + y) * side + x; };
  for (int z = 0; z < side; ++z) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        if (x + 1 < side) pairs.emplace_back(at(x, y, z), at(x + 1, y, z));
        if (y + 1 < side) pairs.emplace_back(at(x, y, z), at(x, y + 1, z));
        if (z + 1 < side) pairs.emplace_back(at(x, y, z), at(x, y, z + 1));
      }
    }
  }
  return pairs;
}

class LargeSystem : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(BlockCholesky, LargeSystem, testing::Values(0, 3, 6, 7),
                         [](const auto& info) {
                           return info.param == 0 ? "Mixed" : "Of" + std::to_string(info.param);
                         });

TEST_P(LargeSystem, IsSolvedWithTheSameBitsOnAnyNumberOfThreads) {
  const int edge = GetParam() == 3 ? 11 : 8;  // small blocks need more of them for a shared front
  for (const bool cube : {false, true}) {
    const int count = cube ? edge * edge * edge : 40 * 40;
    const GridSystem a(cube ? cube_pairs(edge) : grid_pairs(40), sizes(count, GetParam()), 1);
    BlockCholesky solver;
    solver.analyse(a.pattern);
    const Supernodes& structure = solver.structure();
    ASSERT_GT(structure.items(), 8);
    if (cube) {
      // A front that threads share, of several panels and tiles.
      ASSERT_GT(*std::max_element(structure.width.begin() + structure.top, structure.width.end()),
                192);
    }
    std::vector<double> alone(a.right_hand_side.size()), together(alone.size());
    ASSERT_TRUE(solver.factorise(a.values.data(), a.damping.data()));
    solver.solve(a.right_hand_side.data(), alone.data());
    EXPECT_LE(a.residual(alone), 1e-12);
    for (const int threads : {2, 3}) {
      ThreadPool pool(threads);
      solver.use_threads(&pool);
      for (int repeat = 0; repeat < 5; ++repeat) {
        ASSERT_TRUE(solver.factorise(a.values.data(), a.damping.data()));
        std::fill(together.begin(), together.end(), 0.0);
        solver.solve(a.right_hand_side.data(), together.data());
        ASSERT_EQ(std::memcmp(alone.data(), together.data(), alone.size() * sizeof(double)), 0)
            << threads << " threads";
      }
      solver.use_threads(nullptr);
    }
  }
}

TEST_P(LargeSystem, NamesTheSameBadBlockOnAnyNumberOfThreads) {
  GridSystem a(cube_pairs(9), sizes(9 * 9 * 9, GetParam()), 2);
  BlockCholesky solver;
  solver.analyse(a.pattern);
  // One bad block is found; of several, the same on every run.
  a.diagonal_block(300)[0] = -1e6;
  EXPECT_FALSE(solver.factorise(a.values.data(), a.damping.data()));
  EXPECT_EQ(solver.failed_row(), 300);
  for (const int other : {17, 95, 401, 555, 700}) a.diagonal_block(other)[0] = -1e6;
  EXPECT_FALSE(solver.factorise(a.values.data(), a.damping.data()));
  const int expected = solver.failed_row();
  ThreadPool pool(2);
  solver.use_threads(&pool);
  for (int repeat = 0; repeat < 10; ++repeat) {
    EXPECT_FALSE(solver.factorise(a.values.data(), a.damping.data()));
    EXPECT_EQ(solver.failed_row(), expected);
  }
}

TEST_P(LargeSystem, IsFactorisedByTwoThreadsWithoutAllocating) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const GridSystem a(cube_pairs(9), sizes(9 * 9 * 9, GetParam()), 3);
  ThreadPool pool(2);
  BlockCholesky solver;
  solver.use_threads(&pool);
  solver.analyse(a.pattern);
  std::vector<double> x(a.right_hand_side.size());
  const long before = allocation_count();
  const bool good = solver.factorise(a.values.data(), a.damping.data());
  solver.solve(a.right_hand_side.data(), x.data());
  EXPECT_EQ(allocation_count() - before, 0);
  EXPECT_TRUE(good);
}

TEST(BlockCholesky, FillsNoMoreThanTheDenseFactorAndNoLessThanTheMatrix) {
  const GridSystem a(grid_pairs(20), sizes(400, 3), 4);
  BlockCholesky solver;
  solver.analyse(a.pattern);
  EXPECT_GE(solver.factor_size(), 400 * 6 + 760 * 9);
  EXPECT_LE(solver.factor_size(), 1200 * 1201 / 2);
}

TEST(BlockCholesky, IsAnalysedAgainForAPatternOfTheSameSize) {
  BlockCholesky solver;
  for (const int head : {0, 7, 29}) {
    const RandomSystem a(arrow_pairs(30, head), std::vector<int>(30, 3), 3);
    solver.analyse(a.pattern);
    ASSERT_TRUE(solver.factorise(a.values.data(), a.damping.data()));
    std::vector<double> x(a.right_hand_side.size());
    solver.solve(a.right_hand_side.data(), x.data());
    const Eigen::VectorXd& expected = a.expected();
    EXPECT_LE((Eigen::Map<Eigen::VectorXd>(x.data(), expected.size()) - expected).norm(),
              1e-12 * expected.norm());
  }
}

}  // namespace
}  // namespace locograph::test
