#include <locograph/world/voxel_tree.h>

#include <algorithm>
#include <cmath>

namespace locograph {

VoxelTree::VoxelTree(const octomap::OcTree& tree) : resolution_(tree.getResolution()) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (octomap::OcTree::leaf_iterator leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    if (!tree.isNodeOccupied(*leaf)) continue;
    // From the key, not from OctoMap's float coordinates.
    const int extent = 1 << (tree.getTreeDepth() - leaf.getDepth());
    Eigen::Vector3d lower;
    for (unsigned axis = 0; axis < 3; ++axis)
      lower[axis] = ((static_cast<int>(leaf.getKey()[axis]) & ~(extent - 1)) -
                     (1 << (tree.getTreeDepth() - 1))) *
                    resolution_;
    boxes.emplace_back(lower, lower + Eigen::Vector3d::Constant(extent * resolution_));
  }
  if (boxes.empty()) return;
  nodes_.reserve(2 * boxes.size() - 1);
  build(boxes, 0, boxes.size());
}

int VoxelTree::build(std::vector<Eigen::AlignedBox3d>& boxes, std::size_t begin, std::size_t end) {
  const int index = static_cast<int>(nodes_.size());
  Eigen::AlignedBox3d bounds, centres;
  for (std::size_t i = begin; i < end; ++i) {
    bounds.extend(boxes[i]);
    centres.extend(boxes[i].center());
  }
  nodes_.push_back({bounds.min(), bounds.max(), -1});
  if (end - begin == 1) return index;
  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  const std::size_t middle = begin + (end - begin) / 2;
  std::nth_element(boxes.begin() + begin, boxes.begin() + middle, boxes.begin() + end,
                   [axis](const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
                     return a.min()[axis] + a.max()[axis] < b.min()[axis] + b.max()[axis];
                   });
  build(boxes, begin, middle);
  nodes_[index].right = build(boxes, middle, end);
  return index;
}

struct VoxelTree::Search {
  const VoxelTree& tree;
  Query& query;
  Eigen::Vector3d from, to;  // axis of the shape's bounding capsule, world frame
  double floor_z;            // rounded down to a voxel boundary
  bool found = false;

  // The part of a node that counts; false if none does.
  bool crop(const Node& node, Eigen::Vector3d& lower) const {
    lower = node.lower;
    if (node.upper.z() <= floor_z + 1e-9) return false;
    lower.z() = std::max(lower.z(), floor_z);
    return true;
  }

  // Lower bound of the signed distance to everything in the node.
  double bound(const Node& node) const {
    Eigen::Vector3d lower;
    if (!crop(node, lower)) return std::numeric_limits<double>::infinity();
    const Eigen::Vector3d centre = 0.5 * (lower + node.upper);
    const Eigen::Vector3d half = 0.5 * (node.upper - lower);
    const double axis = segment_box_clearance(from - centre, to - centre, half);
    // No point of a box is deeper in it than its least half extent.
    return (axis > 0.0 ? axis : -half.minCoeff()) - query.shape.bounding_capsule_radius();
  }

  bool is_behind(const Node& node) const {
    const Eigen::Vector3d centre = 0.5 * (node.lower + node.upper);
    const Eigen::Vector3d half = 0.5 * (node.upper - node.lower);
    for (const Query::Behind& part : query.behind) {
      const Eigen::Vector3d normal = part.normal.cwiseAbs();
      const double out = part.normal.dot(centre - part.point) + normal.dot(half);
      if (out > part.height) continue;
      const Eigen::Vector3d apart = ((part.point - centre).cwiseAbs() - half).cwiseMax(0.0);
      if (apart.norm() <= part.reach) return true;
    }
    return false;
  }

  bool done() const { return query.best.distance < query.stop_below; }

  void visit(int index, double lower_bound) {
    if (lower_bound >= query.best.distance || done()) return;
    const Node& node = tree.nodes_[index];
    if (node.right < 0) {
      leaf(node);
      return;
    }
    int near = index + 1, far = node.right;
    double near_bound = bound(tree.nodes_[near]);
    double far_bound = bound(tree.nodes_[far]);
    if (far_bound < near_bound) {
      std::swap(near, far);
      std::swap(near_bound, far_bound);
    }
    visit(near, near_bound);
    visit(far, far_bound);
  }

  void leaf(const Node& node) {
    Eigen::Vector3d lower;
    if (!crop(node, lower)) return;
    if ((!query.behind.empty() || query.only_behind) && is_behind(node) != query.only_behind)
      return;
    const ShapeDistance distance =
        shape_distance(query.shape, query.world_from_shape, Eigen::AlignedBox3d(lower, node.upper));
    if (distance.distance >= query.best.distance) return;
    query.best = distance;
    found = true;
  }
};

bool VoxelTree::nearest(Query& query) const {
  if (empty()) return false;
  const ConvexShape& shape = query.shape;
  const Eigen::Vector3d& axis = shape.bounding_axis();
  Search search{*this, query, query.world_from_shape * Eigen::Vector3d(shape.center() - axis),
                query.world_from_shape * Eigen::Vector3d(shape.center() + axis),
                std::floor((query.floor_z + 1e-6) / resolution_) * resolution_};
  search.visit(0, search.bound(nodes_.front()));
  return search.found;
}

}  // namespace locograph
