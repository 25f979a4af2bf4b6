#pragma once
/// Orders of elimination for a block-sparse Cholesky factorisation, computed on the graph whose
/// nodes are block rows.
///
///     const BlockGraph graph = block_graph(pattern);
///     std::vector<int> old_of_new = minimum_degree_order(graph);
///
/// Sources: Amestoy, Davis & Duff 1996 (approximate minimum degree, Eigen's implementation);
/// Karypis & Kumar 1998 (nested dissection, METIS).

#include <locograph/core/block_matrix.h>

#include <vector>

namespace locograph {

/// Neighbours of each block row, both directions, without the diagonal.
struct BlockGraph {
  std::vector<int> begin;  ///< size + 1 entries
  std::vector<int> neighbour;

  int size() const { return static_cast<int>(begin.size()) - 1; }
};

BlockGraph block_graph(const BlockPattern& pattern);

/// Block rows in the order of their elimination.
std::vector<int> minimum_degree_order(const BlockGraph& graph);

/// Was METIS there when this was built?
bool nested_dissection_available();
/// Block rows in the order of their elimination; Error without METIS. The same for the same graph.
std::vector<int> nested_dissection_order(const BlockGraph& graph);

}  // namespace locograph
