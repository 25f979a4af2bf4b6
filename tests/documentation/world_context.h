#pragma once
/// What the examples of world/ take for granted.

#include <documentation/example_context.h>
#include <documentation/example_robots.h>
#include <documentation/example_world.h>
#include <locograph/robots/robot.h>
#include <locograph/world/collision_world.h>
#include <locograph/world/convex_shape.h>
#include <locograph/world/distance_field.h>
#include <locograph/world/octree.h>
#include <locograph/world/perception/perception.h>
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
namespace link_pairs_h {
struct Context : in_world::Context {
  const Robot robot = small_arm();
};
}  // namespace link_pairs_h
/// CENTAURO at home, with cameras of a few pixels that see nothing.
struct PerceptionContext : in_world::Context {
  const std::shared_ptr<const Robot> robot = centauro();
  const Eigen::VectorXd q = robot->named_configuration("home");
  RobotState state = state_at(*robot, q);

  static std::vector<DepthCamera> cameras_of(const Robot& robot) {
    return {depth_camera("eye", robot.root_link(), 16, 12, 1.0)};
  }
  static DepthImage camera_image(double stamp_s) {
    DepthImage image;
    image.stamp_s = stamp_s;
    image.width = 16;
    image.height = 12;
    image.depth_mm.assign(16 * 12, 0);
    return image;
  }
  static void use(const std::shared_ptr<const WorldSnapshot>&) {}
  static void use(const DepthImage&) {}
};
namespace perception_image_source_h {
using Context = PerceptionContext;
}
namespace perception_perception_h {
using Context = PerceptionContext;
}
namespace perception_perception_thread_h {
struct Context : PerceptionContext {
  std::unique_ptr<Perception> perception =
      std::make_unique<Perception>(robot, cameras_of(*robot), World());
  struct {
    void show(const std::shared_ptr<const WorldSnapshot>&) const {}
  } planner;
};
}  // namespace perception_perception_thread_h
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
