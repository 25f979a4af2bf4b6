#pragma once
/// The world around a robot as one value: what is in the way, and what may be touched.
///
///     World world = load_world("hall.bt", "boxes.xml");
///     world.surfaces.push_back(ground());
///     CollisionWorld exact(robot, world);                      // what a judge sees
///     WorldDistance field = distance_view(world, options);     // what edges see
///
/// A world that is kept or shared is kept as a snapshot (world_snapshot.h), which does not change.
/// Map and obstacles are only in the way. Surfaces are in the way, too, and may be touched from the
/// side of their normal; so are bars, from all sides. Solids are in the way through and through,
/// and are touched where surfaces are their faces.

#include <locograph/world/obstacles.h>
#include <octomap/OcTree.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace locograph {

/// A flat rectangle, touched from above in its own frame.
struct Surface {
  std::string name;
  Eigen::Isometry3d world_from_surface = Eigen::Isometry3d::Identity();  ///< z: its normal
  double half_x_m = std::numeric_limits<double>::infinity();
  double half_y_m = std::numeric_limits<double>::infinity();  ///< infinite: without an end
  double friction = 0.0;  ///< Coulomb's coefficient; 0: what the end effector says
};

/// A round bar. Points touch it anywhere around, soles along one line of it; a grasp holds its
/// axis.
struct Bar {
  std::string name;
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::UnitY();  ///< its axis, m
  double radius_m = 0.0;
  double friction = 0.0;  ///< as of surfaces
};

/// A box that is solid inside.
struct SolidBox {
  std::string name;
  Eigen::Isometry3d world_from_box = Eigen::Isometry3d::Identity();  ///< of its middle
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones();
};

struct World {
  std::shared_ptr<const octomap::OcTree> map = {};  ///< null: none
  std::vector<Obstacle> obstacles = {};
  std::vector<Surface> surfaces = {};
  std::vector<Bar> bars = {};
  std::vector<SolidBox> solids = {};
};

/// Whether all of a surface lies in a box or on its border, as its faces do.
bool is_part_of(const SolidBox& box, const Surface& surface);

/// The plane z = 0 without an end.
Surface ground();

/// Map and obstacles of files; empty paths: none. Throws Error for files that cannot be used.
World load_world(const std::filesystem::path& map, const std::filesystem::path& obstacles);

}  // namespace locograph
