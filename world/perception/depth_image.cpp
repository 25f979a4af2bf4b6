#include <locograph/common/error.h>
#include <locograph/world/perception/depth_image.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace locograph {
namespace {

constexpr double kMostDepth_mm = std::numeric_limits<std::uint16_t>::max();

/// 0: none that an image can hold.
std::uint16_t depth_in_mm(double z_m) {
  const double depth = std::round(1e3 * z_m);
  return depth >= 1.0 && depth <= kMostDepth_mm ? static_cast<std::uint16_t>(depth) : 0;
}

/// Column and row where the point is seen; points at z = 0 are nowhere.
Eigen::Vector2d seen_at(const DepthCamera& camera, const Eigen::Vector3d& point) {
  return {camera.fx * point.x() / point.z() + camera.cx,
          camera.fy * point.y() / point.z() + camera.cy};
}

/// Whether the cloud is this camera's image, pixel by pixel.
bool is_image_of(const PointCloud& cloud, const DepthCamera& camera) {
  constexpr double kMostOff = 1.0;
  const auto width = static_cast<std::size_t>(camera.width);
  if (cloud.width != width || cloud.height != static_cast<std::size_t>(camera.height)) return false;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3d& point = cloud.points[i];
    if (!point.allFinite() || depth_in_mm(point.z()) == 0) continue;
    const Eigen::Vector2d own(static_cast<double>(i % width), static_cast<double>(i / width));
    const double off = (seen_at(camera, point) - own).cwiseAbs().maxCoeff();
    if (!(off <= kMostOff)) return false;
  }
  return true;
}

void project(const PointCloud& cloud, const DepthCamera& camera, DepthImage& image) {
  for (const Eigen::Vector3d& point : cloud.points) {
    if (!point.allFinite()) continue;
    const std::uint16_t depth = depth_in_mm(point.z());
    if (depth == 0) continue;
    const Eigen::Vector2d at = seen_at(camera, point);
    const double u = std::round(at.x()), v = std::round(at.y());
    if (!(u >= 0.0 && u < camera.width && v >= 0.0 && v < camera.height)) continue;
    const auto pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) +
                       static_cast<std::size_t>(u);
    std::uint16_t& nearest = image.depth_mm[pixel];
    if (nearest == 0 || depth < nearest) nearest = depth;
  }
}

}  // namespace

int pixels_seen(const DepthImage& image) {
  const auto nothing = std::count(image.depth_mm.begin(), image.depth_mm.end(), 0);
  return static_cast<int>(static_cast<std::ptrdiff_t>(image.depth_mm.size()) - nothing);
}

void remove_nearer_than_range(const DepthCamera& camera, DepthImage& image) {
  const double least = 1e3 * camera.range_min_m;
  for (std::uint16_t& depth : image.depth_mm) {
    if (depth < least) depth = 0;
  }
}

DepthImage depth_image_of(const PointCloud& cloud, const DepthCamera& camera) {
  constexpr double kSame = 1e-6;
  camera.validate();
  if (!cloud.viewpoint.matrix().isIdentity(kSame)) {
    throw Error("the viewpoint of the cloud is not 0 0 0 1 0 0 0",
                "points in the camera's optical frame");
  }
  DepthImage image;
  image.width = camera.width;
  image.height = camera.height;
  image.depth_mm.assign(
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height), 0);
  if (is_image_of(cloud, camera)) {
    for (std::size_t i = 0; i < cloud.points.size(); ++i) {
      const Eigen::Vector3d& point = cloud.points[i];
      if (point.allFinite()) image.depth_mm[i] = depth_in_mm(point.z());
    }
  } else {
    project(cloud, camera, image);
  }
  return image;
}

}  // namespace locograph
