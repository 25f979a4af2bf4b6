#include <locograph/planners/offline/stance/guided_tree.h>

namespace locograph {

bool GuidedTree::to_be_lifted(const Move& move) const {
  const Node& node = nodes[static_cast<std::size_t>(move.node)];
  const std::size_t e = static_cast<std::size_t>(move.effector);
  return node.footing[e] != kFree && node.lifted[e].size() == 0;
}

std::vector<int> GuidedTree::way_to_root(const Footing& from) const {
  std::vector<int> way;
  for (int n = known.at(from); n >= 0; n = nodes[static_cast<std::size_t>(n)].parent) {
    way.push_back(n);
  }
  return way;
}

void GuidedTree::cut_off(int node) {
  for (int n = node; n < static_cast<int>(nodes.size()); ++n) {
    Node& of = nodes[static_cast<std::size_t>(n)];
    if (of.cut || (n != node && !nodes[static_cast<std::size_t>(of.parent)].cut)) continue;
    of.cut = true;
    known.erase(of.footing);
  }
}

void GuidedTree::append(const std::vector<int>& way, StancePath& path) const {
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Node& before = nodes[static_cast<std::size_t>(way[i - 1])];
    const Node& after = nodes[static_cast<std::size_t>(way[i])];
    const int moved = changed_effector(before.footing, after.footing);
    const std::size_t e = static_cast<std::size_t>(moved);
    if (before.footing[e] != kFree && after.footing[e] != kFree) {
      path.append(without(before.footing, moved), before.lifted[e]);
    }
    path.append(after.footing, after.configuration);
  }
}

}  // namespace locograph
