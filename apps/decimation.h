#pragma once
/// Fewer triangles, for pictures only.
///
///     std::vector<Eigen::Vector3d> few = decimated(mesh_triangles("thigh.dae"), 2000);
///
/// Corners in the same cell of a grid become one, their mean; triangles that have lost their area
/// so go (Rossignac & Borrel, "Multi-resolution 3D approximations for rendering complex scenes",
/// 1993). The grid is the finest that leaves no more than most_triangles.

#include <Eigen/Core>
#include <vector>

namespace locograph {

/// corners: three for each triangle.
std::vector<Eigen::Vector3d> decimated(const std::vector<Eigen::Vector3d>& corners,
                                       std::size_t most_triangles);

}  // namespace locograph
