#include "solvers/random_system.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

namespace locograph::test {

Pairs chain_pairs(int size, int band) {
  Pairs pairs;
  for (int c = 0; c < size; ++c) {
    for (int r = std::max(0, c - band); r < c; ++r) pairs.emplace_back(r, c);
  }
  return pairs;
}

Pairs arrow_pairs(int size, int head) {
  Pairs pairs;
  for (int i = 0; i < size; ++i) {
    if (i != head) pairs.emplace_back(head, i);
  }
  return pairs;
}

Pairs grid_pairs(int side) {
  Pairs pairs;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      if (x + 1 < side) pairs.emplace_back(y * side + x, y * side + x + 1);
      if (y + 1 < side) pairs.emplace_back(y * side + x, (y + 1) * side + x);
    }
  }
  return pairs;
}

Pairs random_pairs(int size, int count, unsigned seed) {
  std::mt19937 engine(seed);
  Pairs pairs;
  while (static_cast<int>(pairs.size()) < count) {
    const int a = static_cast<int>(engine() % static_cast<unsigned>(size));
    const int b = static_cast<int>(engine() % static_cast<unsigned>(size));
    if (a != b) pairs.emplace_back(a, b);
  }
  return pairs;
}

BlockPattern make_pattern(Pairs pairs, const std::vector<int>& dimension) {
  const int n = static_cast<int>(dimension.size());
  for (auto& [r, c] : pairs) {
    if (r > c) std::swap(r, c);
  }
  for (int i = 0; i < n; ++i) pairs.emplace_back(i, i);
  std::sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) {
    return std::pair(a.second, a.first) < std::pair(b.second, b.first);
  });
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  BlockPattern pattern;
  pattern.dimension = dimension;
  pattern.kept = n;
  pattern.scalar_begin.assign(1, 0);
  for (const int d : dimension) pattern.scalar_begin.push_back(pattern.scalar_begin.back() + d);
  pattern.column_begin.assign(n + 1, 0);
  pattern.value_offset.assign(1, 0);
  for (const auto& [r, c] : pairs) {
    pattern.row.push_back(r);
    pattern.value_offset.push_back(pattern.value_offset.back() + dimension[r] * dimension[c]);
    ++pattern.column_begin[c + 1];
  }
  for (int c = 0; c < n; ++c) pattern.column_begin[c + 1] += pattern.column_begin[c];
  return pattern;
}

RandomSystem::RandomSystem(const Pairs& pairs, const std::vector<int>& dimension, unsigned seed)
    : pattern(make_pattern(pairs, dimension)), values(pattern.values()) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const int n = pattern.scalar_size();
  for (double& value : values) value = uniform(engine);
  for (int i = 0; i < n; ++i) {
    damping.push_back(1.0 + uniform(engine));
    right_hand_side.push_back(uniform(engine));
  }
  // Diagonally dominant, with diagonal blocks that are full and symmetric.
  std::vector<double> dominance(n, 1.0);
  for_each_block([&](int r, int c, auto block) {
    if (r == c) block = Eigen::MatrixXd(0.5 * (block + block.transpose()));
    for (int i = 0; i < block.rows(); ++i) {
      for (int j = 0; j < block.cols(); ++j) {
        dominance[pattern.scalar_begin[r] + i] += std::abs(block(i, j));
        if (r != c) dominance[pattern.scalar_begin[c] + j] += std::abs(block(i, j));
      }
    }
  });
  for_each_block([&](int r, int c, auto block) {
    if (r != c) return;
    for (int i = 0; i < block.rows(); ++i) block(i, i) += dominance[pattern.scalar_begin[r] + i];
  });
  update_matrix();
}

void RandomSystem::update_matrix() {
  const int n = pattern.scalar_size();
  matrix.setZero(n, n);
  for_each_block([&](int r, int c, auto block) {
    const int at_r = pattern.scalar_begin[r], at_c = pattern.scalar_begin[c];
    matrix.block(at_r, at_c, block.rows(), block.cols()) = block;
    matrix.block(at_c, at_r, block.cols(), block.rows()) = block.transpose();
  });
  for (int i = 0; i < n; ++i) matrix(i, i) += damping[i];
  expected_.resize(0);
  inverse_.resize(0, 0);
}

const Eigen::VectorXd& RandomSystem::expected() const {
  if (expected_.size() == 0) {
    expected_ = matrix.ldlt().solve(
        Eigen::Map<const Eigen::VectorXd>(right_hand_side.data(), pattern.scalar_size()));
  }
  return expected_;
}

const Eigen::MatrixXd& RandomSystem::inverse() const {
  if (inverse_.size() == 0) {
    inverse_ = matrix.ldlt().solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
  }
  return inverse_;
}

}  // namespace locograph::test
