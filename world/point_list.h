#pragma once
/// Points whose coordinates lie in three arrays, as vector registers want them.
///
///     const PointList points{x.data(), y.data(), z.data(), static_cast<int>(x.size())};
///     seen.distances(points, time_s, distances.data());

namespace locograph {

struct PointList {
  const double *x, *y, *z;  ///< world [m]
  int count;
};

}  // namespace locograph
