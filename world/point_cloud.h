#pragma once
/// The points of a PCD file (Point Cloud Library, versions 0.6 and 0.7).
///
///     std::vector<Eigen::Vector3d> points = locograph::load_point_cloud("scan.pcd");
///     World world;
///     locograph::add_cloud(world, "scan", points, 0.7);  // surfaces_of.h
///
/// With the places of points that a sensor did not see, for images:
///
///     const PointCloud cloud = read_point_cloud("scan.pcd");
///     const DepthImage image = depth_image_of(cloud, camera);  // perception/depth_image.h
///
/// `DATA ascii`, `binary` and `binary_compressed`. The fields x, y and z are floats of 4 or 8 bytes
/// anywhere among others, which are ignored. Points are as stored: no viewpoint is applied to them.
///
/// Throws Error, with the line for headers and text, when the file cannot be read, contradicts
/// itself or ends early. What a header promises is compared with the size of the file before memory
/// is taken for it.

#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <vector>

namespace locograph {

struct PointCloud {
  /// Row by row, width * height; those with a coordinate that is not finite are holes.
  std::vector<Eigen::Vector3d> points;
  std::size_t width = 0, height = 0;  ///< height 1: not organised
  /// `VIEWPOINT`: the identity where the file has none.
  Eigen::Isometry3d viewpoint = Eigen::Isometry3d::Identity();
};

/// Holes and all. A viewpoint that is no pose (its quaternion is of length 1 within 1e-3) is an
/// Error.
PointCloud read_point_cloud(const std::filesystem::path& path);

/// The points that are finite, in their order; without one an Error. VIEWPOINT is not looked at.
std::vector<Eigen::Vector3d> load_point_cloud(const std::filesystem::path& path);

}  // namespace locograph
