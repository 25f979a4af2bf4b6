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

/// The parent has the configuration in which its end effector is lifted, the child the one in which
/// it is put down; from the goal the way leads from child to parent.
void GuidedTree::append(const std::vector<int>& way, StancePath& path) const {
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Node& before = nodes[static_cast<std::size_t>(way[i - 1])];
    const Node& after = nodes[static_cast<std::size_t>(way[i])];
    const Node &parent = backwards ? after : before, &child = backwards ? before : after;
    const int moved = changed_effector(before.footing, after.footing);
    const std::size_t e = static_cast<std::size_t>(moved);
    if (before.footing[e] == kFree || after.footing[e] == kFree) {
      path.append(after.footing, child.configuration);
      continue;
    }
    const Eigen::VectorXd &lifted = parent.lifted[e], &put = child.configuration;
    path.append(without(before.footing, moved), backwards ? put : lifted);
    path.append(after.footing, backwards ? lifted : put);
  }
}

}  // namespace locograph
