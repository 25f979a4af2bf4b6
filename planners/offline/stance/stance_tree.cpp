#include <locograph/planners/offline/stance/stance_tree.h>

namespace locograph {

void StanceTree::add(const Footing& footing, int parent) {
  if (!keeps_) return;
  if (parent < 0) numbers_.clear();
  append(footing, parent, true);
  numbers_.push_back(static_cast<int>(plan_.tree.size()) - 1);
}

void StanceTree::add_failed(const Footing& footing, int parent) {
  if (keeps_) append(footing, parent, false);
}

void StanceTree::mark(int node) {
  if (!keeps_) return;
  const int number = numbers_[static_cast<std::size_t>(node)];
  plan_.tree[static_cast<std::size_t>(number)].on_way = true;
}

void StanceTree::append(const Footing& footing, int parent, bool found) {
  StanceTreeNode node;
  node.stance = space_.stance(footing);
  if (parent >= 0) node.parent = numbers_[static_cast<std::size_t>(parent)];
  node.found = found;
  plan_.tree.push_back(std::move(node));
}

void forget_way(StancePlan& plan, std::size_t first) {
  for (std::size_t i = first; i < plan.tree.size(); ++i) plan.tree[i].on_way = false;
}

}  // namespace locograph
