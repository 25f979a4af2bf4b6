#pragma once
/// Parts of surfaces_of.h: the map of what neither rectangles nor bars stand for.
///
///     std::vector<Plate> plates = {{surface, 0.02}};
///     world.map = with_leftovers(world.map, points, plates, bars, 0.03, 0.05);

#include <locograph/common/deadline.h>
#include <locograph/world/world.h>

#include <Eigen/Geometry>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace locograph {

/// A rectangle and how far from its plane points are still of it.
struct Plate {
  Eigen::Isometry3d surface_from_world;
  double half_x_m, half_y_m, tolerance_m;

  Plate(const Surface& surface, double tolerance)
      : surface_from_world(surface.world_from_surface.inverse()),
        half_x_m(surface.half_x_m),
        half_y_m(surface.half_y_m),
        tolerance_m(tolerance) {}
};

/// The map, null for none, joined with the voxels of the points that plates and bars (within
/// bar_tolerance_m of their sides) do not cover; the map itself if they cover all. Voxels that
/// would stand out of a plate, or of the strip of two voxels around it, because of points in or
/// behind its plane are put behind. Throws Error for points out of reach, and OutOfTime.
std::shared_ptr<const octomap::OcTree> with_leftovers(
    const std::shared_ptr<const octomap::OcTree>& map, std::span<const Eigen::Vector3d> points,
    std::span<const Plate> plates, std::span<const Bar> bars, double bar_tolerance_m,
    double voxel_m, const Deadline& deadline = {});

/// Names "NAME 1", "NAME 2", ... by area, the largest first.
void append_surfaces(World& world, const std::string& name, double friction,
                     std::vector<Surface> surfaces);

}  // namespace locograph
