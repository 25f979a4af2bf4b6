#pragma once
/// Distances of many points to a shape or to a field, side by side in vector registers; compiled
/// once for each level of vector instructions (common/simd_level.h). Internal: WorldDistance calls
/// them.
///
/// They agree with Obstacle::sample() and DistanceField::sample() up to rounding, and lower what is
/// there: nearest[i] = min(nearest[i], distance of point i). A point that is no number changes
/// nothing.

#include <locograph/common/level_table.h>
#include <locograph/world/point_list.h>

#include <string>

namespace locograph {

/// A box, sphere or cylinder about its z axis where it is.
struct PlacedShape {
  double axes[9];    ///< of the shape, in the world, by column
  double origin[3];  ///< world
  double size[3];    ///< half of a box's extents; a radius; a radius and half of the height
};

/// See distance_field.h.
struct FieldNodes {
  const float* values;
  int dimensions[3];
  double lower[3], upper[3];
  double inverse_resolution, max_distance;
};

struct PointKernels {
  void (*box)(const PlacedShape& shape, const PointList& points, double* nearest);
  void (*sphere)(const PlacedShape& shape, const PointList& points, double* nearest);
  void (*cylinder)(const PlacedShape& shape, const PointList& points, double* nearest);
  void (*field)(const FieldNodes& field, const PointList& points, double* nearest);
};

LOCOGRAPH_DECLARE_LEVELS(PointKernels, point_kernels);

/// Those of this process. Throws Error like simd_level().
const PointKernels& point_kernels();
/// Those of one of simd_levels(). Throws Error like require_simd_level().
const PointKernels& point_kernels_at(const std::string& level);

}  // namespace locograph
