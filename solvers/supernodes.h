#pragma once
/// The symbolic half of a multifrontal Cholesky factorisation: which block columns are factored
/// together, what their fronts look like, where they are in memory and what may run at once.
///
///     const Supernodes s = supernodes(graph, tree, pattern.dimension);
///     double* panel = factor + s.panel_begin[i];       // padded(width) + padded(below) rows
///
/// A supernode is a set of block columns eliminated together. Its front has `width` scalar pivot
/// rows, padded to whole registers (Kernels::padded), and `below` rows, padded as well; the first
/// `width` columns are a panel of the factor, the rest is the update matrix that it hands to its
/// parent (Duff & Reid 1983; Liu 1992). Which columns are joined is decided by an estimate of the
/// time of a front.
///
/// Order: contiguous ranges of supernodes are items of work. The first items are whole subtrees and
/// wait for nothing; the others are the top of the tree, front by front or a short path of them.
/// Children precede parents everywhere. Nothing here depends on the number of threads.

#include <locograph/solvers/elimination_tree.h>
#include <locograph/solvers/front_kernels.h>
#include <locograph/solvers/item_graph.h>

#include <cstdint>
#include <vector>

namespace locograph {

struct Supernodes {
  std::vector<int> old_of_new, new_of_old;  ///< block rows
  std::vector<int> scalar_begin;            ///< by new block row; size + 1 entries

  std::vector<int> first;        ///< first block column of each supernode; count + 1 entries
  std::vector<int> parent;       ///< -1 for a root
  std::vector<int> child_begin;  ///< into child; count + 1 entries
  std::vector<int> child;
  std::vector<int> width, below;                 ///< scalar columns, and rows under them
  std::vector<int> leading;                      ///< rows of the panel in memory
  std::vector<std::int64_t> panel_begin;         ///< into the factor; count + 1 entries
  std::vector<std::int64_t> vector_begin;        ///< into a vector with one segment for each front
  std::vector<std::int64_t> row_begin;           ///< into row; count + 1 entries
  std::vector<int> row;                          ///< block rows under each supernode, ascending
  std::vector<std::int64_t> run_begin, run_end;  ///< of each supernode, into run
  std::vector<FrontRun> run;
  std::vector<int> pivot_runs;             ///< how many runs of each end among the parent's pivots
  std::vector<std::int64_t> update_begin;  ///< of each update matrix: on a stack, or else shared
  std::int64_t stack_size = 0;             ///< numbers that each thread needs
  std::int64_t shared_size = 0;            ///< numbers for what items hand to others
  std::vector<double> seconds;             ///< estimated, of each front

  std::vector<int> item_begin;  ///< first supernode of each item; items + 1 entries
  int top = 0;                  ///< first supernode that is in no subtree item
  ItemGraph upwards;            ///< children before parents
  ItemGraph downwards;          ///< parents before children; its item i is the i-th from the end

  int count() const { return static_cast<int>(parent.size()); }
  /// Whether an update matrix lives and dies inside one item, on the stack of its thread.
  bool on_stack(int s) const { return parent[s] != -1 && parent[s] < top; }
  int items() const { return upwards.size(); }
};

/// Estimated seconds of a factorisation, from the heights alone.
double factorisation_seconds(const EliminationTree& tree, const std::vector<int>& dimension);

Supernodes supernodes(const BlockGraph& graph, const EliminationTree& tree,
                      const std::vector<int>& dimension);

}  // namespace locograph
