#pragma once
/// A map's distance that is not a DistanceField of an OctoMap, such as that of a window which
/// cameras fill (perception/local_field.h). WorldDistance reads it in the place of a map.
///
///     WorldDistance world;
///     world.source = source;  // std::shared_ptr<const DistanceSource>
///     const double away_m = world.sample_map(point).distance;

#include <locograph/world/distance_sample.h>

namespace locograph {

/// Immutable once others read it: all members are thread-safe.
class DistanceSource {
 public:
  virtual ~DistanceSource() = default;

  /// Never above the true signed distance to what is known to be occupied; at most max_distance(),
  /// where the gradient is zero.
  virtual DistanceSample sample(const Eigen::Vector3d& point) const = 0;
  virtual double max_distance() const = 0;
  /// Whether what is at the point has been seen.
  virtual bool is_known(const Eigen::Vector3d& point) const = 0;
};

}  // namespace locograph
