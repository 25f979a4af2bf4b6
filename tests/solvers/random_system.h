#pragma once
/// Random symmetric positive definite block-sparse systems, and the dense solution to compare with.
///
///     RandomSystem system(chain_pairs(20, 2), std::vector<int>(20, 6), seed);
///     solver.analyse(system.pattern);

#include <locograph/core/block_matrix.h>

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace locograph::test {

using Pairs = std::vector<std::pair<int, int>>;  ///< off-diagonal blocks, in either order

Pairs chain_pairs(int size, int band);
/// One block tied to all others.
Pairs arrow_pairs(int size, int head);
/// side × side blocks, each tied to its right and lower neighbour.
Pairs grid_pairs(int side);
Pairs random_pairs(int size, int count, unsigned seed);

BlockPattern make_pattern(Pairs pairs, const std::vector<int>& dimension);

struct RandomSystem {
  BlockPattern pattern;
  std::vector<double> values, damping, right_hand_side;
  Eigen::MatrixXd matrix;  ///< dense, damping included

  RandomSystem(const Pairs& pairs, const std::vector<int>& dimension, unsigned seed);

  /// f(r, c, map of the block)
  template <class F>
  void for_each_block(F&& f) {
    for (int c = 0; c < pattern.size(); ++c) {
      for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
        const int r = pattern.row[k];
        f(r, c,
          Eigen::Map<Eigen::MatrixXd>(values.data() + pattern.value_offset[k], pattern.dimension[r],
                                      pattern.dimension[c]));
      }
    }
  }
  /// To be called after a change of the values or the damping.
  void update_matrix();
  /// By dense LDLT of the matrix, once.
  const Eigen::VectorXd& expected() const;
  const Eigen::MatrixXd& inverse() const;

 private:
  mutable Eigen::VectorXd expected_;  ///< empty until asked for
  mutable Eigen::MatrixXd inverse_;
};

}  // namespace locograph::test
