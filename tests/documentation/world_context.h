#pragma once
/// What the examples of world/ take for granted.

#include <documentation/example_context.h>
#include <documentation/example_robots.h>
#include <documentation/example_world.h>
#include <locograph/common/simd_level.h>
#include <locograph/robots/robot.h>
#include <locograph/world/collision_world.h>
#include <locograph/world/convex_shape.h>
#include <locograph/world/distance_field.h>
#include <locograph/world/octree.h>
#include <locograph/world/perception/field_buffers.h>
#include <locograph/world/perception/local_map.h>
#include <locograph/world/perception/window_transform.h>
#include <locograph/world/point_cloud.h>
#include <locograph/world/surfaces_of.h>
#include <locograph/world/world_snapshot.h>
#include <locograph/world/world_solids.h>

namespace locograph::documentation::in_world {

/// COMAN+ at home in a room, with all its files.
struct Context {
  const Robot& robot = *coman_plus();
  const World world = small_room();
  const std::vector<Obstacle>& obstacles = world.obstacles;
  const std::vector<Eigen::Isometry3d> world_from_link =
      link_poses(state_at(robot, robot.named_configuration("home")));
  const Eigen::Isometry3d world_from_arm{Eigen::Translation3d(0.0, 0.0, 1.0)},
      world_from_table{Eigen::Translation3d(0.0, 0.5, 0.4)}, world_from_shape = world_from_arm;
  const double time_s = 0.5, margin_m = 0.05;
  const std::shared_ptr<const octomap::OcTree>& tree = world.map;
  const Eigen::Vector3d point = {1.0, 0.0, 1.0}, a_point = {0.0, 0.0, 0.0},
                        b_point = {1.0, 0.2, 0.0};
  const int link = robot.link_index("l_sole");
  std::vector<ConvexShape> solids;
  const ConvexShape shape = ConvexShape::capsule(0.05, 0.3);
  const DistanceField field = DistanceField::from_octree(*tree, {.max_distance_m = 0.5});
  const DistanceFieldOptions options;

  Context() { write_room_files(); }

  static Eigen::Vector3d farthest_point_of_a(const Eigen::Vector3d& direction) {
    return 0.2 * direction.normalized();
  }
  static Eigen::Vector3d farthest_point_of_b(const Eigen::Vector3d& direction) {
    return Eigen::Vector3d(1.0, 0.2, 0.0) + 0.3 * direction.normalized();
  }
  static void report(const std::string&, const std::string&) {}
  static void use(const ShapeDistance&) {}
  static void use(const Surface&) {}
};

namespace collision_world_h {
struct Context : in_world::Context {
  const int sole = link;
};
}  // namespace collision_world_h
namespace leftover_map_h {
struct Context : in_world::Context {
  World world = in_world::Context::world;
  const Surface surface = world.surfaces[1];
  const std::vector<Eigen::Vector3d> points = scanned_points();
  const std::vector<Bar> bars = world.bars;
};
}  // namespace leftover_map_h
namespace distance_source_h {
struct Context : in_world::Context {
  LocalMap map;
  const std::shared_ptr<const DistanceSource> source = map.field();
};
}  // namespace distance_source_h
namespace link_pairs_h {
struct Context : in_world::Context {
  const Robot robot = small_arm();
};
}  // namespace link_pairs_h
namespace perception_field_buffers_h {
struct Context : in_world::Context {
  FieldBuffers buffers{LocalField{}, 3};
  static void fill(LocalField&) {}
};
}  // namespace perception_field_buffers_h
namespace perception_local_field_h {
struct Context : in_world::Context {
  LocalMap map;
  const std::shared_ptr<const LocalField> field = map.field();
  static void slow_down() {}
};
}  // namespace perception_local_field_h
namespace perception_local_map_h {
struct Context : in_world::Context {
  const DepthCamera camera{
      .name = "head", .width = 4, .height = 3, .fx = 2.0, .fy = 2.0, .cx = 1.5, .cy = 1.0};
  const DepthImage image{.width = 4, .height = 3, .depth_mm = std::vector<std::uint16_t>(12, 1500)};
  const Eigen::Isometry3d world_from_optical = world_from_arm;
  const Eigen::Vector3d robot_at = {0.0, 0.0, 0.8};
};
}  // namespace perception_local_map_h
namespace perception_window_transform_h {
struct Context : in_world::Context {
  const VoxelWindow window{.resolution_m = 0.05, .size = {32, 16, 16}};
  const std::vector<std::int8_t> log_odds = std::vector<std::int8_t>(32 * 16 * 16, 0);
};
}  // namespace perception_window_transform_h
namespace planar_patches_h {
struct Context : in_world::Context {
  const std::vector<Eigen::Vector3d> points = scanned_points();
  const Eigen::Vector3d camera_position = {0.0, 0.0, 1.5};
};
}  // namespace planar_patches_h
namespace point_grid_h {
struct Context : in_world::Context {
  const std::vector<Eigen::Vector3d> points = scanned_points();
  const int v = 0;
};
}  // namespace point_grid_h
namespace surfaces_of_h {
struct Context : in_world::Context {
  const Eigen::Isometry3d world_from_mesh = world_from_table;
};
}  // namespace surfaces_of_h

}  // namespace locograph::documentation::in_world
