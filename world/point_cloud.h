#pragma once
/// The points of a PCD file (Point Cloud Library, versions 0.6 and 0.7).
///
///     std::vector<Eigen::Vector3d> points = locograph::load_point_cloud("scan.pcd");
///     World world;
///     locograph::add_cloud(world, "scan", points, 0.7);  // surfaces_of.h
///
/// `DATA ascii`, `binary` and `binary_compressed`. The fields x, y and z are floats of 4 or 8 bytes
/// anywhere among others, which are ignored, as VIEWPOINT is: points are as stored. Those with a
/// coordinate that is not finite (no return of the sensor) are dropped, the others keep their
/// order.
///
/// Throws Error, with the line for headers and text, when the file cannot be read, contradicts
/// itself, ends early or has no point left. What a header promises is compared with the size of the
/// file before memory is taken for it.

#include <Eigen/Core>
#include <filesystem>
#include <vector>

namespace locograph {

std::vector<Eigen::Vector3d> load_point_cloud(const std::filesystem::path& path);

}  // namespace locograph
