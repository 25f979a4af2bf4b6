#pragma once
/// A file of the environment in which surfaces are found.
///
///     const ScannedSurface stairs{.kind = ScannedSurface::Kind::kMesh, .file = "stairs.stl"};

#include <Eigen/Geometry>
#include <filesystem>
#include <string>

namespace locograph {

/// A mesh, cloud or octree of the environment, as the file says it; it is opened by world_of().
struct ScannedSurface {
  enum class Kind { kMesh, kCloud, kOctomap };
  Kind kind = Kind::kMesh;
  std::string name;
  std::filesystem::path file;
  Eigen::Isometry3d world_from_mesh = Eigen::Isometry3d::Identity();
  double scale = 1.0;     ///< of a mesh, before it is moved
  double voxel_m = 0.05;  ///< of a cloud
  double friction = 0.0;  ///< as of surfaces
  int line = 0;
};

}  // namespace locograph
