#include <locograph/world/perception/known_shapes.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace locograph {
namespace {

double distance_to_box(const Eigen::Vector3d& point, const Eigen::Vector3d& half) {
  return (point.cwiseAbs() - half).cwiseMax(0.0).norm();
}

/// The least box along the world's axes around one that may be infinite.
Eigen::AlignedBox3d bounds_of(const Eigen::Isometry3d& pose, const Eigen::Vector3d& half) {
  if (!half.allFinite()) {
    const double all = std::numeric_limits<double>::max();
    return {Eigen::Vector3d::Constant(-all), Eigen::Vector3d::Constant(all)};
  }
  const Eigen::Vector3d reach = pose.linear().cwiseAbs() * half;
  return {pose.translation() - reach, pose.translation() + reach};
}

bool is_floor(const Surface& surface) {
  const bool ends = std::isfinite(surface.half_x_m) && std::isfinite(surface.half_y_m);
  constexpr double kUpright = 1.0 - 1e-9;
  return !ends && surface.world_from_surface.linear()(2, 2) > kUpright;
}

}  // namespace

std::vector<Eigen::Vector3i> voxels_of_shapes(const World& world, const VoxelWindow& window,
                                              double band_m) {
  constexpr double kNoise_m = 0.02;
  const double near_m = std::max(band_m, 0.5 * std::sqrt(3.0) * window.resolution_m + kNoise_m);
  std::vector<Eigen::Vector3i> voxels;
  const auto centre = [&](const Eigen::Vector3i& index) -> Eigen::Vector3d {
    return window.resolution_m * (index.cast<double>().array() + 0.5);
  };
  const auto add_box = [&](const Eigen::Isometry3d& pose, const Eigen::Vector3d& half) {
    const Eigen::Isometry3d from_world = pose.inverse();
    window.each_in(bounds_of(pose, half.array() + near_m), [&](const auto& index) {
      if (distance_to_box(from_world * centre(index), half) <= near_m) voxels.push_back(index);
    });
  };
  for (const Surface& surface : world.surfaces) {
    if (is_floor(surface)) continue;
    add_box(surface.world_from_surface, {surface.half_x_m, surface.half_y_m, 0.0});
  }
  for (const SolidBox& box : world.solids) add_box(box.world_from_box, 0.5 * box.size_m);
  for (const Bar& bar : world.bars) {
    const Eigen::Vector3d along = bar.to - bar.from;
    const double length2 = along.squaredNorm(), reach_m = bar.radius_m + near_m;
    Eigen::AlignedBox3d box(bar.from);
    box.extend(bar.to);
    window.each_in({box.min().array() - reach_m, box.max().array() + reach_m},
                   [&](const auto& index) {
                     const Eigen::Vector3d from = centre(index) - bar.from;
                     const double share =
                         length2 > 0.0 ? std::clamp(from.dot(along) / length2, 0.0, 1.0) : 0.0;
                     if ((from - share * along).norm() <= reach_m) voxels.push_back(index);
                   });
  }
  return voxels;
}

}  // namespace locograph
