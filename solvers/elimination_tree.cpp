#include <locograph/solvers/elimination_tree.h>

namespace locograph {
namespace {

std::vector<int> inverse(const std::vector<int>& order) {
  std::vector<int> result(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) result[order[i]] = static_cast<int>(i);
  return result;
}

std::vector<int> parents(const BlockGraph& graph, const std::vector<int>& old_of_new,
                         const std::vector<int>& new_of_old) {
  const int n = graph.size();
  std::vector<int> parent(n, -1), ancestor(n, -1);
  for (int j = 0; j < n; ++j) {
    const int old = old_of_new[j];
    for (int k = graph.begin[old]; k < graph.begin[old + 1]; ++k) {
      // Up from each i < j of row j to the root of what has been built, which j becomes.
      for (int i = new_of_old[graph.neighbour[k]]; i != -1 && i < j;) {
        const int next = ancestor[i];
        ancestor[i] = j;
        if (next == -1) parent[i] = j;
        i = next;
      }
    }
  }
  return parent;
}

/// Heights of the columns; nodes are in postorder.
std::vector<int> heights(const BlockGraph& graph, const EliminationTree& tree,
                         const std::vector<int>& dimension) {
  const int n = graph.size();
  std::vector<int> first(n, -1), most(n, -1), previous(n, -1), ancestor(n), height(n);
  for (int j = 0; j < n; ++j) {
    height[j] = first[j] == -1 ? dimension[tree.old_of_new[j]] : 0;
    for (int i = j; i != -1 && first[i] == -1; i = tree.parent[i]) first[i] = j;
    ancestor[j] = j;
  }
  for (int j = 0; j < n; ++j) {
    const int old = tree.old_of_new[j];
    if (tree.parent[j] != -1) height[tree.parent[j]] -= dimension[old];
    for (int k = graph.begin[old]; k < graph.begin[old + 1]; ++k) {
      const int i = tree.new_of_old[graph.neighbour[k]];
      // j is a leaf of the subtree of row i when none of its descendants is in it.
      if (i <= j || first[j] <= most[i]) continue;
      most[i] = first[j];
      const int weight = dimension[tree.old_of_new[i]];
      height[j] += weight;
      if (previous[i] != -1) {
        int top = previous[i];
        while (top != ancestor[top]) top = ancestor[top];
        for (int s = previous[i]; s != top;) {
          const int next = ancestor[s];
          ancestor[s] = top;
          s = next;
        }
        height[top] -= weight;
      }
      previous[i] = j;
    }
    if (tree.parent[j] != -1) ancestor[j] = tree.parent[j];
  }
  for (int j = 0; j < n; ++j) {
    if (tree.parent[j] != -1) height[tree.parent[j]] += height[j];
  }
  return height;
}

}  // namespace

std::vector<int> postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  std::vector<int> child(n, -1), sibling(n, -1), order, stack;
  order.reserve(n);
  for (int i = n - 1; i >= 0; --i) {
    if (parent[i] == -1) continue;
    sibling[i] = child[parent[i]];
    child[parent[i]] = i;
  }
  for (int root = 0; root < n; ++root) {
    if (parent[root] != -1) continue;
    stack.push_back(root);
    while (!stack.empty()) {
      const int node = stack.back();
      if (child[node] != -1) {
        stack.push_back(child[node]);
        child[node] = sibling[child[node]];
      } else {
        order.push_back(node);
        stack.pop_back();
      }
    }
  }
  return order;
}

EliminationTree elimination_tree(const BlockGraph& graph, const std::vector<int>& dimension,
                                 std::vector<int> old_of_new) {
  const int n = graph.size();
  EliminationTree tree;
  tree.new_of_old = inverse(old_of_new);
  const std::vector<int> parent = parents(graph, old_of_new, tree.new_of_old);
  const std::vector<int> order = postorder(parent);
  const std::vector<int> place = inverse(order);
  tree.old_of_new.resize(n);
  tree.parent.resize(n);
  for (int i = 0; i < n; ++i) {
    tree.old_of_new[i] = old_of_new[order[i]];
    tree.new_of_old[tree.old_of_new[i]] = i;
    tree.parent[i] = parent[order[i]] == -1 ? -1 : place[parent[order[i]]];
  }
  tree.height = heights(graph, tree, dimension);
  return tree;
}

}  // namespace locograph
