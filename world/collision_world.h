#pragma once
/// Exact distances between a robot's collision shapes, the voxels of a map, primitive obstacles,
/// surfaces, bars, solid boxes and the robot itself, for checkers.
///
///     CollisionWorld exact(robot, world);
///     CollisionWorld::Closest c = exact.environment_distance(world_from_link, time_s);
///     if (c.distance_m < 0.01) report(robot.links()[c.link].name, c.what);
///
///     CollisionWorld::Touch foot{.position = {0, 0.1, 0}, .surfaces = {0}, .links = {sole}};
///     CollisionWorld::Surroundings around =
///         exact.surroundings({.world_from_link = world_from_link, .touches = {&foot, 1}});
///     // around.obstacle, around.surface: what no link touches
///     // around.touched: how deep links touch
///
/// Distances of spheres and capsules to each other and to boxes (voxels too) are closed forms; the
/// others are certified to 1e-5 m, see convex_shape.h. A mesh (STL) counts as its convex hull, and
/// a missing one is an error. A surface without an end is solid below; a rectangle is a plate of
/// 0.2 mm, so that what is behind it is free; both count from the side of their normal where they
/// are touched. The faces of a solid box are its border, not plates: what is inside it is found. A
/// bar is a cylinder with flat ends. world_from_link has one pose per link of the robot, in the
/// robot's order. Lengths in metres, world frame. The constructor copies what it needs of the robot
/// and the world: later changes to them are not seen. Const members are thread-safe. Throws Error
/// when the number of poses is not the number of links, and for surfaces, bars and boxes whose
/// sizes are not positive.

#include <locograph/world/obstacles.h>
#include <locograph/world/world.h>
#include <octomap/OcTree.h>

#include <Eigen/Geometry>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace locograph {

class Robot;
struct WorldSolids;

struct CollisionWorldOptions {
  /// Distances are computed up to here; a Closest with nothing nearer has this distance, link -1.
  double cutoff_m = 0.5;
  /// Links that may touch the floor: for them, voxels whose top is at or below floor_z_m + 1e-6 do
  /// not count.
  std::vector<int> ignore_floor_links;
  double floor_z_m = 0.0;
};

class CollisionWorld {
 public:
  /// What is nearest. On penetration distance_m is minus the depth: the largest depth of one shape
  /// in one voxel or obstacle.
  struct Closest {
    double distance_m = 0.0;
    int link = -1;        ///< index of the robot's link
    int other_link = -1;  ///< self_distance: the other link
    std::string what;     ///< "voxel", the obstacle's name, or the other link's name
    Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< on the link's shape, nearest to the other
  };

  /// A place that links may touch, and which links. What they touch there are the surfaces and
  /// bars named, and no other: one may hold what is in front of the next one. A solid box with a
  /// surface that they touch is touched as a whole, but for its faces further away than reach_m and
  /// those that come out of the plane through `position` along `normal`. Obstacles at rest and
  /// voxels are as much of the ground as the surface is where they come no further than 0.1 mm out
  /// of that plane, within reach_m of the position.
  struct Touch {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< of length 1
    std::vector<int> surfaces = {};                     ///< of World::surfaces
    std::vector<int> bars = {};                         ///< of World::bars
    std::vector<int> links = {};
    double reach_m = 0.3;  ///< how far from the position; a sole reaches as far as its corners
    /// Links may be 0.1 mm in what they touch, as where a contact opens or closes, and what is
    /// deeper counts as of any other link.
    bool barely = false;
  };
  struct Query {
    std::span<const Eigen::Isometry3d> world_from_link;
    double time_s = 0.0;
    std::span<const Touch> touches = {};
    double cutoff_m = 0.5;  ///< as in CollisionWorldOptions
    /// The same of surfaces, bars and boxes: mostly it matters only whether links reach into them.
    double surface_cutoff_m = 0.15;
    /// Indices of the obstacles that count, there at that time or not; null: all that are there.
    const std::vector<std::size_t>* obstacles = nullptr;
  };
  struct Surroundings {
    Closest obstacle;  ///< of the voxels and obstacles that the link does not touch
    Closest surface;   ///< of the surfaces, bars and boxes that it does not touch; of those that it
                       ///< touches barely, 0.1 mm more than the distance
    /// Minus the largest depth of a link in what it touches; 0 and link -1 if there is none.
    Closest touched;
  };

  /// All of the world. Voxels whose top is at or below the highest level surface without an end are
  /// that surface, for all links. The solids may be shared with other robots in the same world.
  CollisionWorld(const Robot& robot, std::shared_ptr<const WorldSolids> solids,
                 const CollisionWorldOptions& options = {});
  CollisionWorld(const Robot& robot, const World& world, const CollisionWorldOptions& options = {});
  /// tree may be null: obstacles only.
  CollisionWorld(const Robot& robot, std::shared_ptr<const octomap::OcTree> tree,
                 std::vector<Obstacle> obstacles, const CollisionWorldOptions& options = {});
  ~CollisionWorld();
  CollisionWorld(CollisionWorld&&) noexcept;
  CollisionWorld& operator=(CollisionWorld&&) noexcept;

  /// All of the world, touched or not.
  Surroundings surroundings(const Query& query) const;
  /// Of the obstacles alone.
  Surroundings obstacles(const Query& query) const;

  /// Map and obstacles. Returns early with the first distance below stop_below, if there is one.
  Closest environment_distance(std::span<const Eigen::Isometry3d> world_from_link, double time_s,
                               double stop_below = -std::numeric_limits<double>::infinity()) const;

  /// Over the pairs of links of Robot::self_collision_pairs().
  Closest self_distance(std::span<const Eigen::Isometry3d> world_from_link) const;
  /// Up to a cutoff of its own.
  Closest self_distance(std::span<const Eigen::Isometry3d> world_from_link, double cutoff_m) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace locograph
