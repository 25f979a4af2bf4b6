#pragma once
/// A bounding volume tree over the occupied leaves of an OctoMap, for the nearest voxel and for
/// rays.
///
///     locograph::VoxelTree voxels(*tree);
///     locograph::VoxelTree::Query query{shape, world_from_shape};
///     query.best.distance = 0.5;  // look no further
///     if (voxels.nearest(query)) use(query.best);
///
///     const Eigen::Vector3d forward(1.0, 0.0, 0.0);
///     const auto is_near = [](const auto& lower, const auto&) { return lower.x() < 2.0; };
///     voxels.visit(forward, is_near, [&](const auto&, const auto&) { ++leaves; });
///
/// Leaves keep the size they have in the octree. Immutable; queries are thread-safe, and those of
/// spheres and capsules do not allocate.

#include <locograph/world/convex_shape.h>
#include <octomap/OcTree.h>

#include <Eigen/Geometry>
#include <limits>
#include <vector>

namespace locograph {

class VoxelTree {
 public:
  struct Query {
    const ConvexShape& shape;
    const Eigen::Isometry3d& world_from_shape;
    /// Voxels whose top is at or below this height do not count.
    double floor_z = -std::numeric_limits<double>::infinity();
    /// Voxels in these parts do not count, or, with `only_behind`, no others: those that come out
    /// of the plane by no more than `height`, and have a point within `reach`.
    struct Behind {
      Eigen::Vector3d point, normal;
      double height = 0.0, reach = 0.0;
    };
    std::vector<Behind> behind = {};
    bool only_behind = false;
    /// Return the first distance below this.
    double stop_below = -std::numeric_limits<double>::infinity();
    /// In: only what is nearer than best.distance is looked for. Out: the nearest found.
    ShapeDistance best{std::numeric_limits<double>::infinity(), {}, {}};
  };

  explicit VoxelTree(const octomap::OcTree& tree);

  bool empty() const { return nodes_.empty(); }

  /// True if something nearer than the initial query.best.distance was found.
  bool nearest(Query& query) const;

  /// Calls leaf(lower, upper) with the corners of each leaf in those parts of the tree whose bounds
  /// enter(lower, upper) does not refuse: along the direction, part by part, so that a leaf may
  /// come before one in front of it. Does not allocate.
  template <class Enter, class Leaf>
  void visit(const Eigen::Vector3d& direction, Enter&& enter, Leaf&& leaf) const {
    if (!empty()) visit_below(0, direction, enter, leaf);
  }

 private:
  struct Node {
    Eigen::Vector3d lower, upper;
    int right = -1;  // right child; the left one follows its parent; -1: a leaf
  };
  struct Search;

  template <class Enter, class Leaf>
  void visit_below(int index, const Eigen::Vector3d& direction, Enter& enter, Leaf& leaf) const {
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (!enter(node.lower, node.upper)) return;
    if (node.right < 0) {
      leaf(node.lower, node.upper);
      return;
    }
    const Node& left = nodes_[static_cast<std::size_t>(index) + 1];
    const Node& right = nodes_[static_cast<std::size_t>(node.right)];
    const bool left_first = direction.dot(left.lower + left.upper - right.lower - right.upper) <= 0;
    visit_below(left_first ? index + 1 : node.right, direction, enter, leaf);
    visit_below(left_first ? node.right : index + 1, direction, enter, leaf);
  }

  int build(std::vector<Eigen::AlignedBox3d>& boxes, std::size_t begin, std::size_t end);

  std::vector<Node> nodes_;
  double resolution_ = 0.0;
};

}  // namespace locograph
