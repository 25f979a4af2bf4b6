#pragma once
/// What the examples of world/ take for granted.

#include <locograph/robots/robot.h>
#include <locograph/world/collision_world.h>
#include <locograph/world/convex_shape.h>
#include <locograph/world/distance_field.h>
#include <locograph/world/octree.h>
#include <locograph/world/point_cloud.h>
#include <locograph/world/surfaces_of.h>
#include <locograph/world/world.h>

#include <memory>
#include <string>
#include <vector>

namespace locograph::documentation::in_world {

extern const Robot robot;
extern const std::vector<Obstacle> obstacles;
extern const std::vector<Eigen::Isometry3d> world_from_link;
extern const Eigen::Isometry3d world_from_arm, world_from_table, world_from_shape;
extern const double time_s, margin_m;
extern const std::shared_ptr<const octomap::OcTree> tree;
extern const Eigen::Vector3d point, a_point, b_point;
extern const int link;
extern std::vector<ConvexShape> solids;
extern const ConvexShape shape;
extern const DistanceField field;
extern const DistanceFieldOptions options;
Eigen::Vector3d farthest_point_of_a(const Eigen::Vector3d& direction);
Eigen::Vector3d farthest_point_of_b(const Eigen::Vector3d& direction);
void report(const std::string& link, const std::string& what);
void use(const ShapeDistance& nearest);

namespace collision_world_h {
extern const World world;
extern const int sole;
}  // namespace collision_world_h
namespace box_tree_h {
extern const World world;
void use(const Surface& surface);
}  // namespace box_tree_h
namespace touchable_solids_h {
extern const World world;
}
namespace distance_view_h {
extern const World world;
}
namespace leftover_map_h {
extern World world;
extern const Surface surface;
extern const std::vector<Eigen::Vector3d> points;
extern const std::vector<Bar> bars;
}  // namespace leftover_map_h
namespace planar_patches_h {
extern const std::vector<Eigen::Vector3d> points;
extern const Eigen::Vector3d camera_position;
}  // namespace planar_patches_h
namespace point_grid_h {
extern const std::vector<Eigen::Vector3d> points;
extern const int v;
}  // namespace point_grid_h
namespace surfaces_of_h {
extern const Eigen::Isometry3d world_from_mesh;
}

}  // namespace locograph::documentation::in_world
