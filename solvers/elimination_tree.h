#pragma once
/// The elimination tree of a block-sparse matrix in a given order, and how tall each column of its
/// Cholesky factor is: all there is to know of the factor's cost, in almost linear time.
///
///     const BlockGraph graph = block_graph(pattern);
///     const EliminationTree tree =
///         elimination_tree(graph, pattern.dimension, minimum_degree_order(graph));
///
/// The order comes back as a postorder of the tree: the same fill, children before parents, and
/// every subtree contiguous. Sources: Liu 1990 (the tree), Gilbert, Ng & Peyton 1994 (the heights,
/// here weighted by the size of the blocks).

#include <locograph/solvers/ordering.h>

#include <vector>

namespace locograph {

struct EliminationTree {
  std::vector<int> old_of_new, new_of_old;
  std::vector<int> parent;  ///< by new index, -1 for a root
  std::vector<int> height;  ///< scalar rows of each block column of the factor, its diagonal too
};

/// dimension: of each block row, by old index.
EliminationTree elimination_tree(const BlockGraph& graph, const std::vector<int>& dimension,
                                 std::vector<int> old_of_new);

/// A postorder of a forest, children in ascending order: result[k] is the k-th node.
std::vector<int> postorder(const std::vector<int>& parent);

}  // namespace locograph
