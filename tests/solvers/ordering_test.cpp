#include <gtest/gtest.h>
#include <locograph/solvers/elimination_tree.h>
#include <locograph/solvers/supernodes.h>

#include <numeric>

#include "solvers/random_system.h"

namespace locograph::test {
namespace {

void expect_permutation(std::vector<int> order, int size) {
  std::sort(order.begin(), order.end());
  std::vector<int> expected(size);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(order, expected);
}

TEST(Ordering, OrdersEveryBlockRowOnce) {
  for (const Pairs& pairs : {Pairs(), chain_pairs(49, 2), grid_pairs(7), random_pairs(49, 90, 1)}) {
    const BlockGraph graph = block_graph(make_pattern(pairs, std::vector<int>(49, 3)));
    expect_permutation(minimum_degree_order(graph), 49);
    if (nested_dissection_available()) {
      expect_permutation(nested_dissection_order(graph), 49);
      EXPECT_EQ(nested_dissection_order(graph), nested_dissection_order(graph));
    }
  }
}

/// Heights of the columns of the factor, by eliminating one after the other.
std::vector<int> heights_by_elimination(const BlockPattern& pattern, const EliminationTree& tree) {
  const int n = pattern.size();
  std::vector<std::vector<bool>> joined(n, std::vector<bool>(n, false));
  for (int c = 0; c < n; ++c) {
    for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
      const int a = tree.new_of_old[pattern.row[k]], b = tree.new_of_old[c];
      joined[a][b] = joined[b][a] = true;
    }
  }
  std::vector<int> heights;
  for (int c = 0; c < n; ++c) {
    int height = 0;
    for (int r = c; r < n; ++r) {
      if (!joined[r][c]) continue;
      height += pattern.dimension[tree.old_of_new[r]];
      for (int s = c; s < n; ++s) {
        if (joined[s][c]) joined[r][s] = true;
      }
    }
    heights.push_back(height);
  }
  return heights;
}

TEST(EliminationTree, HasTheHeightsThatEliminationGives) {
  std::vector<int> mixed;
  for (int i = 0; i < 49; ++i) mixed.push_back(1 + (i * 5) % 7);
  for (const Pairs& pairs :
       {Pairs(), chain_pairs(49, 3), grid_pairs(7), arrow_pairs(49, 20), random_pairs(49, 80, 2)}) {
    for (const std::vector<int>& dimension : {std::vector<int>(49, 6), mixed}) {
      const BlockPattern pattern = make_pattern(pairs, dimension);
      const BlockGraph graph = block_graph(pattern);
      std::vector<int> natural(49);
      std::iota(natural.begin(), natural.end(), 0);
      for (const std::vector<int>& order : {natural, minimum_degree_order(graph)}) {
        const EliminationTree tree = elimination_tree(graph, dimension, order);
        expect_permutation(tree.old_of_new, 49);
        EXPECT_EQ(tree.height, heights_by_elimination(pattern, tree));
        for (int i = 0; i < 49; ++i) EXPECT_TRUE(tree.parent[i] == -1 || tree.parent[i] > i);
      }
    }
  }
}

TEST(Supernodes, HoldEveryBlockColumnOnceAndPassTheirRowsToTheirParent) {
  const std::vector<int> dimension(900, 3);
  const BlockPattern pattern = make_pattern(grid_pairs(30), dimension);
  const BlockGraph graph = block_graph(pattern);
  const Supernodes s =
      supernodes(graph, elimination_tree(graph, dimension, minimum_degree_order(graph)), dimension);
  expect_permutation(s.old_of_new, 900);
  EXPECT_EQ(s.first.front(), 0);
  EXPECT_EQ(s.first.back(), 900);
  EXPECT_EQ(s.item_begin.back(), s.count());
  for (int i = 0; i < s.count(); ++i) {
    EXPECT_LT(s.first[i], s.first[i + 1]);
    int below = 0;
    for (std::int64_t k = s.row_begin[i]; k < s.row_begin[i + 1]; ++k) {
      below += 3;
      EXPECT_GE(s.row[k], s.first[i + 1]);
    }
    EXPECT_EQ(below, s.below[i]);
    EXPECT_EQ(s.parent[i] == -1, below == 0);
    int passed = 0;
    for (std::int64_t r = s.run_begin[i]; r < s.run_end[i]; ++r) passed += s.run[r].length;
    EXPECT_EQ(passed, below);
  }
}

}  // namespace
}  // namespace locograph::test
