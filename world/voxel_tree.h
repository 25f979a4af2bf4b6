#pragma once
/// A bounding volume tree over the occupied leaves of an OctoMap, for nearest-voxel queries.
///
///     locograph::VoxelTree voxels(*tree);
///     locograph::VoxelTree::Query query{shape, world_from_shape};
///     query.best.distance = 0.5;  // look no further
///     if (voxels.nearest(query)) use(query.best);
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

 private:
  struct Node {
    Eigen::Vector3d lower, upper;
    int right = -1;  // right child; the left one follows its parent; -1: a leaf
  };
  struct Search;

  int build(std::vector<Eigen::AlignedBox3d>& boxes, std::size_t begin, std::size_t end);

  std::vector<Node> nodes_;
  double resolution_ = 0.0;
};

}  // namespace locograph
