#pragma once
/// Flat places and round bars in a cloud of points.
///
///     std::vector<Surface> steps = planar_patches(points, {.viewpoint = camera_position});
///     std::vector<Bar> rungs = bars_in(points);
///
/// Patches: normals of the voxels' points by principal components, regions grown from the flattest
/// voxel over neighbours of the same plane, planes by least squares, and rectangles of cells of the
/// voxel's size that hold a point each. A rectangle's side runs along the innermost of the
/// outermost points of its cells, so that it never reaches over the edge of what was seen. The
/// voxel should be twice the distance between points or more: cells without a point are holes.
/// Rectangles of one region are in one plane and may overlap.
///
/// Deterministic, without random samples. About n log n in the number of points. Lengths in metres.
/// Throws Error for coordinates and voxels outside ranges.h.

#include <locograph/common/deadline.h>
#include <locograph/world/world.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace locograph {

struct PatchOptions {
  double voxel_m = 0.05;
  double least_length_m = 0.15, least_width_m = 0.1;  ///< of a rectangle
  double plane_distance_m = 0.02;  ///< of a region's points from its plane; noisy ones: up to twice
  double angle_rad = 0.3;          ///< between a voxel's normal and its region's
  /// Normals point to the side where it is. Without one, normals of patches up to 60 degrees steep
  /// point up. Those of steeper ones point to where the points beside their lower half are, the
  /// floor in front of them; if there are none, away from those beside their upper half, the top of
  /// a box; else to the side with more points.
  std::optional<Eigen::Vector3d> viewpoint;
  Deadline deadline = {};  ///< when it has passed, OutOfTime is thrown
};

/// Without names and friction, the largest first.
std::vector<Surface> planar_patches(std::span<const Eigen::Vector3d> points,
                                    const PatchOptions& options = {});

/// A region of planar_patches() that has a rectangle.
struct PlanarRegion {
  double tolerance_m = 0.0;           ///< points of the region are no further from its plane
  std::vector<std::uint32_t> points;  ///< indices, also of points that no rectangle covers
  std::vector<Surface> surfaces;      ///< one or more
};
/// Those with most points first.
std::vector<PlanarRegion> planar_regions(std::span<const Eigen::Vector3d> points,
                                         const PatchOptions& options = {});

struct BarOptions {
  double voxel_m = 0.05;
  double least_radius_m = 0.004, most_radius_m = 0.06;
  double least_length_m = 0.15;
  double distance_m = 0.015;  ///< of a bar's points from its side; twice that counts as on it
  Deadline deadline = {};     ///< as of PatchOptions
};

/// Rows of voxels with points around a line; cylinders by least squares in the points' distances.
/// A bar must be seen over 100 degrees around. Flat regions confuse it where they touch bars: leave
/// their points out. Without names and friction, the longest first.
std::vector<Bar> bars_in(std::span<const Eigen::Vector3d> points, const BarOptions& options = {});

}  // namespace locograph
