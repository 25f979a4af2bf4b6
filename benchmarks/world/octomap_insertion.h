#pragma once
/// A depth image into an OctoMap, by OctoMap itself.
///
///     octomap::OcTree tree(0.05);
///     insert_into(tree, camera, world_from_optical, image, {.range_m = 4.0});

#include <locograph/world/perception/depth_camera.h>
#include <locograph/world/perception/depth_image.h>
#include <octomap/OcTree.h>

#include <Eigen/Geometry>

namespace locograph {

struct OctomapInsertion {
  double range_m = 4.0;  ///< longer rays end there, in nothing
  bool discretised =
      true;  ///< one ray for each voxel that pixels end in, instead of for each pixel
};

inline void insert_into(octomap::OcTree& tree, const DepthCamera& camera,
                        const Eigen::Isometry3d& world_from_optical, const DepthImage& image,
                        const OctomapInsertion& how) {
  octomap::Pointcloud cloud;
  cloud.reserve(image.depth_mm.size());
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double depth = 1e-3 * image.depth_mm[static_cast<std::size_t>(v) * camera.width + u];
      if (depth == 0.0) continue;
      const Eigen::Vector3f point = (world_from_optical * camera.point(u, v, depth)).cast<float>();
      cloud.push_back(point.x(), point.y(), point.z());
    }
  }
  const Eigen::Vector3f from = world_from_optical.translation().cast<float>();
  tree.insertPointCloud(cloud, {from.x(), from.y(), from.z()}, how.range_m, false, how.discretised);
}

}  // namespace locograph
