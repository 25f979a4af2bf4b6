#pragma once
/// Signed Euclidean distance to the occupied voxels of an OctoMap, with gradient, on a grid.
///
///     locograph::DistanceFieldOptions options;
///     options.max_distance_m = 0.5;
///     options.lower = Eigen::Vector3d(-1, -2, 0);
///     options.upper = Eigen::Vector3d(5, 2, 2);
///     locograph::DistanceField field = locograph::DistanceField::from_octree(*tree, options);
///     locograph::DistanceSample s = field.sample(Eigen::Vector3d(1, 0, 0.4));
///
/// The value is positive outside the occupied voxels, negative inside, and conservative: it is
/// never above the true signed distance to the union of the occupied cubes (outside by
/// a derivation, inside as far as a random search over voxel patterns shows, both in
/// node_distances.h; a flat wall reads 0.62 voxels too near, an isolated voxel's corner 0).
/// Nodes sit at the voxel centres of the box of interest; between them the value is trilinear and
/// the gradient is the exact derivative of that interpolant. Where the value reaches max_distance_m
/// it stays there and the gradient is zero; inside obstacles it is not limited.
///
/// Outside the box, with c the point clamped to it and r = |p - c|, the value is
/// sqrt(value(c)^2 + r^2) (value(c) + r where value(c) < 0), at most max_distance_m: continuous,
/// and conservative as long as everything occupied lies inside the box, which is so for the default
/// box.
///
/// Owns its grid (4 bytes per voxel of the box); the octree is not needed afterwards. All const
/// members are thread-safe and do not allocate.

#include <locograph/world/distance_sample.h>
#include <locograph/world/distance_source.h>
#include <locograph/world/obstacles.h>
#include <locograph/world/point_list.h>
#include <locograph/world/voxel_tree.h>
#include <octomap/OcTree.h>

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace locograph {

struct DistanceFieldOptions {
  double max_distance_m = 1.0;
  /// Corners of the box of interest, world frame. Default: the bounds of the occupied leaves, grown
  /// by max_distance_m. Obstacles outside the box but within max_distance_m of it count too.
  std::optional<Eigen::Vector3d> lower, upper;
  bool unknown_is_occupied = false;
  /// Voxels whose top is at or below this height are the floor and are left out.
  double ground_z = -std::numeric_limits<double>::infinity();

  /// Throws Error on a distance that is not positive and finite, or a box that is not one.
  void validate() const;
};

class DistanceField {
 public:
  /// Throws Error on invalid options and on a box of more than 1e8 voxels.
  static DistanceField from_octree(const octomap::OcTree& tree,
                                   const DistanceFieldOptions& options = {});

  DistanceSample sample(const Eigen::Vector3d& point) const;
  double distance(const Eigen::Vector3d& point) const;
  /// nearest[i] = min(nearest[i], distance(point i)) up to rounding, several points at a time.
  void lower(const PointList& points, double* nearest) const;

  /// No obstacle within max_distance_m of the box: max_distance_m everywhere, gradient zero.
  bool empty() const { return values_.empty(); }

  double resolution() const { return resolution_; }
  double max_distance() const { return max_distance_; }
  /// Positions of the first and the last node: the region in which the grid is interpolated.
  const Eigen::Vector3d& lower() const { return lower_; }
  const Eigen::Vector3d& upper() const { return upper_; }
  /// Number of nodes along x, y, z; zero when empty.
  const std::array<int, 3>& dimensions() const { return dimensions_; }
  /// Node values [m], z fastest: index (x * ny + y) * nz + z.
  std::span<const float> values() const { return values_; }

 private:
  DistanceSample sample_inside(const Eigen::Vector3d& point) const;

  std::vector<float> values_;
  std::array<int, 3> dimensions_{};
  Eigen::Vector3d lower_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d upper_ = Eigen::Vector3d::Zero();
  double resolution_ = 0.0;
  double inverse_resolution_ = 0.0;
  double max_distance_ = 0.0;
};

/// Map and obstacles together: the smaller of the field's value and the exact distances to the
/// obstacles at a time, at most max_distance(). Of a map that is too large for a field there are
/// its leaves, whatever their sizes: then its distance is exact, too, and takes longer. Where
/// cameras fill a map, their window stands in its place.
struct WorldDistance {
  std::shared_ptr<const DistanceField> map;  ///< may be null
  std::shared_ptr<const VoxelTree> leaves;   ///< instead of map; may be null
  double leaves_floor_z = -std::numeric_limits<double>::infinity();  ///< see VoxelTree::Query
  std::shared_ptr<const DistanceSource> source;  ///< instead of map; may be null
  std::vector<Obstacle> obstacles;
  double max_distance_without_map_m = 1.0;

  double max_distance() const {
    if (map) return map->max_distance();
    return source ? source->max_distance() : max_distance_without_map_m;
  }
  bool sees_map() const { return leaves || source || (map && !map->empty()); }
  /// Whether what is at the point has been seen; of a map and of obstacles all is.
  bool is_known(const Eigen::Vector3d& point) const { return !source || source->is_known(point); }
  /// To the map alone.
  DistanceSample sample_map(const Eigen::Vector3d& point) const;
  /// nearest[i] = min(nearest[i], sample_map(point i).distance), as DistanceField::lower().
  void lower_to_map(const PointList& points, double* nearest) const;
  DistanceSample sample(const Eigen::Vector3d& point, double time_s) const;
  double distance(const Eigen::Vector3d& point, double time_s) const {
    return sample(point, time_s).distance;
  }
  /// The same of many points, several at a time; up to rounding.
  void distances(const PointList& points, double time_s, double* distances) const;
};

}  // namespace locograph
