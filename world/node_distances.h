#pragma once
/// Distances between the nodes of a grid, which are voxel centres; what DistanceField and
/// LocalField have in common. Internal.
///
///     const CellNodes nodes{0.1, 0.1, 0.1, 0.1, 0.2, 0.2, 0.2, 0.2};
///     DistanceSample sample = between_nodes(nodes, 0.5, 0.0, 0.0, 10.0, 1.0);  // 0.15, along x
///
/// Notation: h voxel size, x_i grid nodes = voxel centres, d_c(x) the distance from a free x to the
/// nearest occupied centre, d_f(x) from an occupied x to the nearest free centre. Node values are
///   D(x) - s h,  D = d_c where free, h - d_f where occupied
/// (continuous slope 1 through a flat wall), and s is the smallest number that makes the trilinear
/// interpolant a lower bound. Outside: let c be the centre of the cube nearest to p. For every node
/// D(x_i) <= |x_i - c|, so the interpolant is at most sum_i w_i |x_i - c| - s h, whose largest
/// excess over the distance from p to the cube of c is found at the cube's corner:
///   s = (0 + 3 * 1 + 3 * sqrt 2 + sqrt 3) / 8 = 1.1218.
/// Inside the same s suffices (largest excess found by random search over voxel patterns: 1.1218).
/// A flat wall is seen s - 1/2 = 0.62 voxels too early.

#include <locograph/world/distance_sample.h>

#include <cmath>

namespace locograph {

inline constexpr double kNodeOffset = 1.121834;  // s, rounded up

/// At the corners of a cell; the digits are steps along x, y, z.
struct CellNodes {
  double v000, v001, v010, v011, v100, v101, v110, v111;
};

/// tx, ty, tz in [0, 1]: where in the cell.
inline DistanceSample between_nodes(const CellNodes& n, double tx, double ty, double tz,
                                    double inverse_resolution, double max_distance) {
  // Along x, then y, then z; a lerp of equal numbers is exact.
  const double x00 = n.v000 + tx * (n.v100 - n.v000), x01 = n.v001 + tx * (n.v101 - n.v001);
  const double x10 = n.v010 + tx * (n.v110 - n.v010), x11 = n.v011 + tx * (n.v111 - n.v011);
  const double xy0 = x00 + ty * (x10 - x00), xy1 = x01 + ty * (x11 - x01);

  const double g00 = n.v100 - n.v000, g01 = n.v101 - n.v001;
  const double g10 = n.v110 - n.v010, g11 = n.v111 - n.v011;
  const double gx0 = g00 + ty * (g10 - g00), gx1 = g01 + ty * (g11 - g01);

  DistanceSample sample;
  sample.distance = xy0 + tz * (xy1 - xy0);
  if (sample.distance >= static_cast<double>(static_cast<float>(max_distance))) {
    sample.distance = max_distance;
    return sample;
  }
  sample.gradient[0] = (gx0 + tz * (gx1 - gx0)) * inverse_resolution;
  sample.gradient[1] = ((x10 - x00) + tz * ((x11 - x01) - (x10 - x00))) * inverse_resolution;
  sample.gradient[2] = (xy1 - xy0) * inverse_resolution;
  return sample;
}

/// For a point outside of the box of nodes: sample is that of the box's nearest point, out the way
/// from there to the point.
inline DistanceSample beyond_nodes(DistanceSample sample, const Eigen::Vector3d& out,
                                   double max_distance) {
  // |p - o|^2 >= |p - c|^2 + |c - o|^2 for every o in a convex set whose projection of p is c.
  const double r = out.norm();
  const double d = sample.distance;
  const double value = d > 0.0 ? std::hypot(d, r) : d + r;
  if (value >= max_distance) return {max_distance, Eigen::Vector3d::Zero()};
  for (int axis = 0; axis < 3; ++axis) {
    if (out[axis] != 0.0)
      sample.gradient[axis] = out[axis] / (d > 0.0 ? value : r);
    else if (d > 0.0)
      sample.gradient[axis] *= d / value;
  }
  sample.distance = value;
  return sample;
}

}  // namespace locograph
