#include <locograph/solvers/cost_model.h>
#include <locograph/solvers/kernels.h>
#include <locograph/solvers/supernodes.h>

#include <algorithm>
#include <numeric>

namespace locograph {
namespace {

/// Which supernode each column is in: sets of columns of the elimination tree, named by their last.
struct Partition {
  std::vector<int> parent;  ///< of the supernode named by its index; -1 for a root
  std::vector<int> width, height;
  std::vector<int> into;     ///< the supernode it was merged into, itself if none
  std::vector<int> members;  ///< the supernodes that are left, children before parents
};

/// Maximal sets of columns with the same rows: joining them costs nothing. A set is named by its
/// last column.
Partition without_fill(const EliminationTree& tree, const std::vector<int>& dimension) {
  const int n = static_cast<int>(tree.parent.size());
  Partition p{
      std::vector<int>(n, -1), std::vector<int>(n), std::vector<int>(n), std::vector<int>(n), {}};
  for (int begin = 0; begin < n;) {
    int last = begin;
    int width = dimension[tree.old_of_new[begin]];
    while (last + 1 < n && tree.parent[last] == last + 1 &&
           tree.height[last + 1] == tree.height[last] - dimension[tree.old_of_new[last]]) {
      width += dimension[tree.old_of_new[++last]];
    }
    for (int c = begin; c <= last; ++c) p.into[c] = last;
    p.width[last] = width;
    p.height[last] = tree.height[begin];
    p.members.push_back(last);
    begin = last + 1;
  }
  for (const int s : p.members) {
    if (tree.parent[s] != -1) p.parent[s] = p.into[tree.parent[s]];
  }
  return p;
}

/// Merges children into parents as long as the front of both is estimated to take less time than
/// the two fronts.
void merge_by_time(Partition& p) {
  const int n = static_cast<int>(p.parent.size());
  std::vector<int> child(n, -1), sibling(n, -1);
  for (auto s = p.members.rbegin(); s != p.members.rend(); ++s) {
    if (p.parent[*s] == -1) continue;
    sibling[*s] = child[p.parent[*s]];
    child[p.parent[*s]] = *s;
  }
  for (const int s : p.members) {
    double own = front_seconds(p.width[s], p.height[s] - p.width[s]);
    int kept = -1;
    for (int c = child[s]; c != -1;) {
      const int next = sibling[c];
      const int width = p.width[s] + p.width[c];
      const int height = p.height[s] + p.width[c];
      const double joined = front_seconds(width, height - width);
      if (joined <= own + front_seconds(p.width[c], p.height[c] - p.width[c])) {
        p.into[c] = s;
        p.width[s] = width;
        p.height[s] = height;
        own = joined;
        // Its children are ours now. They are not weighed again, which keeps this linear.
        for (int g = child[c]; g != -1;) {
          const int after = sibling[g];
          p.parent[g] = s;
          sibling[g] = kept;
          kept = g;
          g = after;
        }
      } else {
        sibling[c] = kept;
        kept = c;
      }
      c = next;
    }
    child[s] = kept;
  }
  std::erase_if(p.members, [&](int s) { return p.into[s] != s; });
}

/// Supernodes of the partition, by postorder, in an order in which items are contiguous.
struct Schedule {
  std::vector<int> order;  ///< positions in the postorder
  std::vector<int> item_begin;
  int top = 0;
};

/// Subtrees of about a sixteenth of the work each become items: enough of them for a few threads
/// to finish together. Above them every front is an item, or a path of small fronts.
Schedule schedule(const std::vector<int>& parent, const std::vector<double>& seconds) {
  constexpr double kShare = 1.0 / 16.0;
  constexpr double kWorthDividing = 50e-6;  // starting and joining threads takes a few microseconds
  constexpr double kWorthItem = 5e-6;
  const int n = static_cast<int>(parent.size());
  std::vector<double> subtree = seconds;
  std::vector<int> size(n, 1);
  double total = 0.0;
  for (int s = 0; s < n; ++s) {
    total += seconds[s];
    if (parent[s] == -1) continue;
    subtree[parent[s]] += subtree[s];
    size[parent[s]] += size[s];
  }
  const double most = total < kWorthDividing ? 2.0 * total : kShare * total;
  const auto is_top = [&](int s) { return subtree[s] > most; };
  // Whole subtrees, in postorder, are gathered until an item has its share.
  struct Item {
    double seconds;
    int begin, end;  // of roots
  };
  std::vector<int> roots, top_children(n, 0);
  for (int s = 0; s < n; ++s) {
    if (is_top(s)) {
      if (parent[s] != -1) ++top_children[parent[s]];
    } else if (parent[s] == -1 || is_top(parent[s])) {
      roots.push_back(s);
    }
  }
  std::vector<Item> items;
  for (int r = 0; r < static_cast<int>(roots.size()); ++r) {
    if (items.empty() || items.back().seconds + subtree[roots[r]] > most) {
      items.push_back({0.0, r, r});
    }
    items.back().seconds += subtree[roots[r]];
    items.back().end = r + 1;
  }
  Schedule result;
  result.order.reserve(n);
  result.item_begin.push_back(0);
  for (const Item& item : items) {
    for (int r = item.begin; r < item.end; ++r) {
      for (int s = roots[r] - size[roots[r]] + 1; s <= roots[r]; ++s) result.order.push_back(s);
    }
    result.item_begin.push_back(static_cast<int>(result.order.size()));
  }
  result.top = static_cast<int>(result.order.size());
  double gathered = 0.0;
  for (int s = 0, below = -1; s < n; ++s) {
    if (!is_top(s)) continue;
    const bool on_path = below != -1 && parent[below] == s && top_children[s] == 1;
    if (below != -1 && !(on_path && gathered + seconds[s] < kWorthItem)) {
      result.item_begin.push_back(static_cast<int>(result.order.size()));
      gathered = 0.0;
    }
    result.order.push_back(s);
    gathered += seconds[s];
    below = s;
  }
  if (result.item_begin.back() != n) result.item_begin.push_back(n);
  return result;
}

/// Numbers supernodes and block columns in their final order.
void number(const Partition& p, const EliminationTree& tree, const std::vector<int>& dimension,
            Supernodes& out) {
  const int columns = static_cast<int>(tree.parent.size());
  const int count = static_cast<int>(p.members.size());
  std::vector<int> place(columns, -1);
  for (int i = 0; i < count; ++i) place[p.members[i]] = i;
  std::vector<int> parent(count);
  for (int i = 0; i < count; ++i) {
    const int above = p.parent[p.members[i]];
    parent[i] = above == -1 ? -1 : place[above];
  }
  const std::vector<int> order = postorder(parent);
  std::vector<int> rank(count);
  for (int i = 0; i < count; ++i) rank[order[i]] = i;
  std::vector<int> ordered_parent(count);
  std::vector<double> seconds(count);
  for (int i = 0; i < count; ++i) {
    const int s = p.members[order[i]];
    ordered_parent[i] = parent[order[i]] == -1 ? -1 : rank[parent[order[i]]];
    seconds[i] = front_seconds(p.width[s], p.height[s] - p.width[s]);
  }
  const Schedule plan = schedule(ordered_parent, seconds);
  out.item_begin = plan.item_begin;
  out.top = plan.top;
  std::vector<int> final_of(count);
  for (int i = 0; i < count; ++i) final_of[plan.order[i]] = i;
  out.parent.resize(count);
  out.width.resize(count);
  out.below.resize(count);
  out.seconds.resize(count);
  for (int i = 0; i < count; ++i) {
    const int old = plan.order[i], s = p.members[order[old]];
    out.parent[i] = ordered_parent[old] == -1 ? -1 : final_of[ordered_parent[old]];
    out.width[i] = p.width[s];
    out.below[i] = p.height[s] - p.width[s];
    out.seconds[i] = seconds[old];
  }
  // Columns of a supernode keep their order: it is a postorder, descendants come first.
  std::vector<int> of_column(columns);
  out.first.assign(count + 1, 0);
  for (int c = 0; c < columns; ++c) {
    int s = p.into[c];
    while (p.into[s] != s) s = p.into[s];
    of_column[c] = final_of[rank[place[s]]];
    ++out.first[of_column[c] + 1];
  }
  std::partial_sum(out.first.begin(), out.first.end(), out.first.begin());
  std::vector<int> next(out.first.begin(), out.first.end() - 1);
  out.old_of_new.resize(columns);
  out.new_of_old.resize(columns);
  for (int c = 0; c < columns; ++c) {
    const int at = next[of_column[c]]++;
    out.old_of_new[at] = tree.old_of_new[c];
    out.new_of_old[tree.old_of_new[c]] = at;
  }
  out.scalar_begin.assign(columns + 1, 0);
  for (int c = 0; c < columns; ++c) {
    out.scalar_begin[c + 1] = out.scalar_begin[c] + dimension[out.old_of_new[c]];
  }
}

void list_children(Supernodes& s) {
  const int count = s.count();
  s.child_begin.assign(count + 1, 0);
  for (const int parent : s.parent) {
    if (parent != -1) ++s.child_begin[parent + 1];
  }
  std::partial_sum(s.child_begin.begin(), s.child_begin.end(), s.child_begin.begin());
  s.child.resize(s.child_begin.back());
  std::vector<int> next(s.child_begin.begin(), s.child_begin.end() - 1);
  for (int i = 0; i < count; ++i) {
    if (s.parent[i] != -1) s.child[next[s.parent[i]]++] = i;
  }
}

/// Rows under each supernode: its own of H and those of its children.
void list_rows(const BlockGraph& graph, Supernodes& s) {
  const int count = s.count();
  std::vector<int> mark(s.old_of_new.size(), -1);
  s.row_begin.assign(1, 0);
  s.row.clear();
  for (int i = 0; i < count; ++i) {
    const int end = s.first[i + 1];
    const auto add = [&](int r) {
      if (r < end || mark[r] == i) return;
      mark[r] = i;
      s.row.push_back(r);
    };
    for (int c = s.first[i]; c < end; ++c) {
      const int old = s.old_of_new[c];
      for (int k = graph.begin[old]; k < graph.begin[old + 1]; ++k) {
        add(s.new_of_old[graph.neighbour[k]]);
      }
    }
    for (int k = s.child_begin[i]; k < s.child_begin[i + 1]; ++k) {
      const std::int64_t rows_end = s.row_begin[s.child[k] + 1];
      for (std::int64_t r = s.row_begin[s.child[k]]; r < rows_end; ++r) add(s.row[r]);
    }
    std::sort(s.row.begin() + s.row_begin[i], s.row.end());
    s.row_begin.push_back(static_cast<std::int64_t>(s.row.size()));
  }
}

/// Memory of panels and front vectors, and where the rows of each update matrix go in its parent.
void lay_out(Supernodes& s) {
  const Kernels& registers = kernels();
  const int count = s.count();
  s.leading.resize(count);
  s.panel_begin.assign(1, 0);
  s.vector_begin.assign(1, 0);
  for (int i = 0; i < count; ++i) {
    s.leading[i] = registers.padded(s.width[i]) + registers.padded(s.below[i]);
    s.panel_begin.push_back(s.panel_begin.back() + std::int64_t{s.leading[i]} * s.width[i]);
    s.vector_begin.push_back(s.vector_begin.back() + s.leading[i]);
  }
  std::vector<int> place(s.old_of_new.size());
  s.run.clear();
  s.run_begin.assign(count, 0);
  s.run_end.assign(count, 0);
  s.pivot_runs.assign(count, 0);
  for (int p = 0; p < count; ++p) {
    if (s.child_begin[p] == s.child_begin[p + 1]) continue;
    for (int c = s.first[p]; c < s.first[p + 1]; ++c) {
      place[c] = s.scalar_begin[c] - s.scalar_begin[s.first[p]];
    }
    int next = registers.padded(s.width[p]);
    for (std::int64_t k = s.row_begin[p]; k < s.row_begin[p + 1]; ++k) {
      place[s.row[k]] = next;
      next += s.scalar_begin[s.row[k] + 1] - s.scalar_begin[s.row[k]];
    }
    for (int k = s.child_begin[p]; k < s.child_begin[p + 1]; ++k) {
      const int i = s.child[k];
      const std::size_t begin = s.run.size();
      int from = 0;
      for (std::int64_t r = s.row_begin[i]; r < s.row_begin[i + 1]; ++r) {
        const int row = s.row[r], to = place[row];
        const int length = s.scalar_begin[row + 1] - s.scalar_begin[row];
        const bool pivot = row < s.first[p + 1];
        // A run does not reach from the pivots into the rows below them.
        const bool first_below = !pivot && s.row[std::max(r - 1, s.row_begin[i])] < s.first[p + 1];
        if (s.run.size() > begin && !first_below && s.run.back().to + s.run.back().length == to) {
          s.run.back().length += length;
        } else {
          s.run.push_back({from, to, length});
          if (pivot) ++s.pivot_runs[i];
        }
        from += length;
      }
      s.run_begin[i] = static_cast<std::int64_t>(begin);
      s.run_end[i] = static_cast<std::int64_t>(s.run.size());
    }
  }
}

/// Places of the update matrices, which live from their front to that of their parent. In a
/// subtree item, children of a front lie on top of one stack while its own goes on the other, so
/// two stacks are enough, one for each parity of the depth; every item starts with empty ones.
/// Above, fronts run side by side: there a matrix takes the places of its grandchildren, whose
/// parents are done when it begins.
void place_updates(Supernodes& s) {
  const Kernels& registers = kernels();
  const int count = s.count();
  std::vector<int> depth(count, 0);
  for (int i = count - 1; i >= 0; --i) depth[i] = s.parent[i] == -1 ? 0 : depth[s.parent[i]] + 1;
  const auto size = [&](int i) { return std::int64_t{s.below[i]} * registers.padded(s.below[i]); };
  s.update_begin.assign(count, 0);
  std::int64_t peak[2] = {0, 0};
  for (int item = 0; s.item_begin[item] < s.top; ++item) {
    std::int64_t cursor[2] = {0, 0};
    for (int i = s.item_begin[item]; i < s.item_begin[item + 1]; ++i) {
      const int mine = depth[i] & 1;
      if (s.on_stack(i)) {
        s.update_begin[i] = cursor[mine];
        cursor[mine] += size(i);
        peak[mine] = std::max(peak[mine], cursor[mine]);
      }
      for (int k = s.child_begin[i]; k < s.child_begin[i + 1]; ++k) {
        cursor[1 - mine] -= size(s.child[k]);
      }
    }
  }
  s.stack_size = peak[0] + peak[1];
  for (int i = 0; i < s.top; ++i) {
    if (s.on_stack(i) && (depth[i] & 1) != 0) s.update_begin[i] += peak[0];
  }

  // What the shared matrices of a subtree need, by parity relative to its root.
  std::vector<std::int64_t> same(count, 0), other(count, 0);
  for (int i = 0; i < count; ++i) {
    if (s.on_stack(i)) continue;
    std::int64_t grandchildren = 0;
    if (i >= s.top) {
      for (int k = s.child_begin[i]; k < s.child_begin[i + 1]; ++k) {
        other[i] += same[s.child[k]];
        grandchildren += other[s.child[k]];
      }
    }
    same[i] = std::max(size(i), grandchildren);
  }
  // From the roots down: where the numbers of either parity begin.
  std::vector<std::int64_t> same_begin(count, 0), other_begin(count, 0);
  s.shared_size = 0;
  for (int i = count - 1; i >= 0; --i) {
    if (s.on_stack(i)) continue;
    if (s.parent[i] == -1) {
      same_begin[i] = s.shared_size;
      other_begin[i] = s.shared_size + same[i];
      s.shared_size += same[i] + other[i];
    }
    s.update_begin[i] = same_begin[i];
    if (i < s.top) continue;
    std::int64_t next_same = same_begin[i], next_other = other_begin[i];
    for (int k = s.child_begin[i]; k < s.child_begin[i + 1]; ++k) {
      const int child = s.child[k];
      same_begin[child] = next_other;
      other_begin[child] = next_same;
      next_other += same[child];
      next_same += other[child];
    }
  }
}

void connect_items(Supernodes& s) {
  const int items = static_cast<int>(s.item_begin.size()) - 1;
  std::vector<int> item_of(s.count());
  std::vector<double> seconds(items, 0.0);
  for (int item = 0; item < items; ++item) {
    for (int i = s.item_begin[item]; i < s.item_begin[item + 1]; ++i) {
      item_of[i] = item;
      seconds[item] += s.seconds[i];
    }
  }
  std::vector<std::pair<int, int>> up, down;
  for (int i = 0; i < s.count(); ++i) {
    if (s.parent[i] == -1 || item_of[i] == item_of[s.parent[i]]) continue;
    up.emplace_back(item_of[i], item_of[s.parent[i]]);
    down.emplace_back(items - 1 - up.back().second, items - 1 - up.back().first);
  }
  s.upwards = ItemGraph(up, seconds);
  std::reverse(seconds.begin(), seconds.end());
  s.downwards = ItemGraph(down, seconds);
}

}  // namespace

double factorisation_seconds(const EliminationTree& tree, const std::vector<int>& dimension) {
  Partition p = without_fill(tree, dimension);
  merge_by_time(p);
  double total = 0.0;
  for (const int s : p.members) total += front_seconds(p.width[s], p.height[s] - p.width[s]);
  return total;
}

Supernodes supernodes(const BlockGraph& graph, const EliminationTree& tree,
                      const std::vector<int>& dimension) {
  Partition p = without_fill(tree, dimension);
  merge_by_time(p);
  Supernodes s;
  number(p, tree, dimension, s);
  list_children(s);
  list_rows(graph, s);
  lay_out(s);
  place_updates(s);
  connect_items(s);
  return s;
}

}  // namespace locograph
