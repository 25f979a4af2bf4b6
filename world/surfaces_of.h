#pragma once
/// Adds what a sensor or a designer knows of a place to a world: what is in the way, and the flat
/// places and bars of it that may be touched.
///
///     World world;
///     add_cloud(world, "scan", load_point_cloud("scan.pcd"), 0.7);
///     add_octomap(world, "hall", load_octree("hall.bt"), 0.7);
///     add_mesh(world, "rocks", "rocks.stl", world_from_mesh, 1.0, 0.7);
///     world.surfaces[0].name;  // "scan 1": its largest rectangle
///     world.bars[0].name;      // "scan bar 1": its longest bar
///
/// What rectangles and bars are is in the way as such, and not in the map: a voxel around a floor
/// would stand out of it, under every foot. Voxels of the rest that would reach over a rectangle,
/// or over a strip of two voxels around it, from points in or behind its plane are put behind that
/// plane. Rectangles are thin plates; behind them the world is as free as the map says.
///
/// Lengths in metres. friction as of Surface. On an Error, and on OutOfTime, the world is as it
/// was.

#include <locograph/world/planar_patches.h>
#include <locograph/world/world.h>
#include <octomap/OcTree.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace locograph {

/// Patches of the cloud, bars of what is left, and of that the rest in voxels of options.voxel_m.
/// Throws Error as planar_patches() does, and for points that a map of such voxels does not reach
/// (1638 m from the origin for 0.05 m).
void add_cloud(World& world, const std::string& name, std::span<const Eigen::Vector3d> points,
               double friction, const PatchOptions& options = {}, const BarOptions& bars = {});

/// The tree joined with the world's map, all of it, and rectangles on its occupied voxels' faces:
/// towards free space; in a tree that knows no free space, towards unknown. Normals are the axes'
/// directions; sides are those of voxels. Throws Error without a tree, and for one whose occupied
/// voxels have more than ten million faces in planes that need them one by one: where all leaves
/// are large, few large cells do.
void add_octomap(World& world, const std::string& name,
                 const std::shared_ptr<const octomap::OcTree>& tree, double friction,
                 const PatchOptions& options = {});

struct MeshOptions {
  double cell_m = 0.02;                               ///< of the rectangles, about
  double voxel_m = 0.02;                              ///< of the map
  double least_length_m = 0.15, least_width_m = 0.1;  ///< of a rectangle
  Deadline deadline = {};                             ///< as of PatchOptions
};

/// An STL file's surface, corners scaled and then moved. Triangles that share edges and a plane (to
/// 1 mm and half a degree) are one face; its rectangles are of cells that are wholly inside, holes
/// left out, and touched from the side from which corners run counter-clockwise. Triangles need not
/// close a solid, and what is inside one is free. Very large meshes get coarser voxels: at most
/// some five million samples. Throws Error for what stl_triangles() refuses, a scale that is not
/// positive, and a mesh outside ranges.h or out of the map's reach.
void add_mesh(World& world, const std::string& name, const std::filesystem::path& stl_file,
              const Eigen::Isometry3d& world_from_mesh, double scale, double friction,
              const MeshOptions& options = {});

}  // namespace locograph
