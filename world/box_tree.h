#pragma once
/// Boxes in space, and which of them are near: for worlds with thousands of surfaces.
///
///     const BoxTree tree(bounds_of(world.surfaces));
///     for (const int s : tree.touching(box_around(point, 0.5))) use(world.surfaces[s]);
///     tree.each_touching(box_around(point, 0.5), [&](int s) { use(world.surfaces[s]); });
///
/// Immutable; queries are thread-safe. World frame, metres. Boxes may be without an end.

#include <locograph/world/world.h>

#include <Eigen/Geometry>
#include <limits>
#include <span>
#include <vector>

namespace locograph {

class BoxTree {
 public:
  BoxTree() = default;
  explicit BoxTree(const std::vector<Eigen::AlignedBox3d>& boxes);

  /// Numbers of the boxes that have a point in common with this one, ascending.
  std::vector<int> touching(const Eigen::AlignedBox3d& box) const;
  /// Calls f(number) for each of them, always in the same order, which is the tree's own. Does not
  /// allocate.
  template <class F>
  void each_touching(const Eigen::AlignedBox3d& box, F&& f) const {
    for (const int number : endless_) f(number);
    if (!nodes_.empty()) visit(0, box, f);
  }
  /// The lowest number among them that is(number) holds for, -1: none. Where boxes lie on each
  /// other it does not ask for all of them.
  template <class F>
  int first_touching(const Eigen::AlignedBox3d& box, F&& is) const {
    int first = std::numeric_limits<int>::max();
    for (const int number : endless_) {
      if (number < first && is(number)) first = number;
    }
    if (!nodes_.empty()) visit_first(0, box, is, first);
    return first == std::numeric_limits<int>::max() ? -1 : first;
  }

 private:
  struct Node {
    Eigen::AlignedBox3d bounds;
    int right = -1;   ///< the right child; the left one follows its parent; -1: a leaf
    int number = -1;  ///< of a leaf's box; else the lowest below
  };

  void build(const std::vector<Eigen::AlignedBox3d>& boxes, std::span<int> numbers);
  template <class F>
  void visit(int index, const Eigen::AlignedBox3d& box, F& f) const {
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (!node.bounds.intersects(box)) return;
    if (node.right < 0) {
      f(node.number);
      return;
    }
    visit(index + 1, box, f);
    visit(node.right, box, f);
  }
  template <class F>
  void visit_first(int index, const Eigen::AlignedBox3d& box, F& is, int& first) const {
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (node.number >= first || !node.bounds.intersects(box)) return;
    if (node.right < 0) {
      if (is(node.number)) first = node.number;
      return;
    }
    const bool left = number(index + 1) < number(node.right);
    visit_first(left ? index + 1 : node.right, box, is, first);
    visit_first(left ? node.right : index + 1, box, is, first);
  }
  int number(int node) const { return nodes_[static_cast<std::size_t>(node)].number; }

  std::vector<Node> nodes_;
  std::vector<int> endless_;  ///< boxes that are near everywhere, or nearly
};

/// All points no further from this one along any axis.
Eigen::AlignedBox3d box_around(const Eigen::Vector3d& point, double reach_m);
Eigen::AlignedBox3d bounds_of(const Surface& surface);
std::vector<Eigen::AlignedBox3d> bounds_of(std::span<const Surface> surfaces);
Eigen::AlignedBox3d bounds_of(const SolidBox& box);
/// For each surface the first solid that it is part of, -1: none. The solids' faces are known so.
std::vector<int> solids_of_surfaces(const World& world);

}  // namespace locograph
