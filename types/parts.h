#pragma once
/// Sets of numbers that are tied together: union-find.
///
///     Parts parts(graph.vertex_slots());
///     parts.join(a, b);
///     bool connected = parts.first(a) == parts.first(b);

#include <algorithm>
#include <numeric>
#include <vector>

namespace locograph {

class Parts {
 public:
  explicit Parts(int size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }
  /// The lowest number of the part.
  int first(int v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(int a, int b) {
    a = first(a);
    b = first(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

}  // namespace locograph
