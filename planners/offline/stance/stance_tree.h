#pragma once
/// Keeps what a search for stances tries in StancePlan::tree, where StancePlannerOptions::keep_tree
/// asks for it; otherwise it does nothing.
///
///     StanceTree tree(space, options, plan);
///     tree.add(start, -1);
///     tree.add_failed(without(start, 0), 0);
///     tree.add(without(start, 1), 0);
///     tree.mark(1);
///
/// Searches number their nodes from 0 for each tree that they begin, with -1 for its root's parent;
/// what failed has no number.

#include <locograph/planners/offline/stance/stance_space.h>

#include <vector>

namespace locograph {

class StanceTree {
 public:
  StanceTree(const StanceSpace& space, const StancePlannerOptions& options, StancePlan& plan)
      : space_(space), plan_(plan), keeps_(options.keep_tree) {}

  /// The search's next node.
  void add(const Footing& footing, int parent);
  /// A transition that was not found.
  void add_failed(const Footing& footing, int parent);
  /// The node lies on the way to a goal.
  void mark(int node);

 private:
  void append(const Footing& footing, int parent, bool found);

  const StanceSpace& space_;
  StancePlan& plan_;
  bool keeps_;
  std::vector<int> numbers_;  ///< in the plan, of the nodes of the tree that is being grown
};

/// The way through the nodes from `first` on was refused.
void forget_way(StancePlan& plan, std::size_t first);

}  // namespace locograph
