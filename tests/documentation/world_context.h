#pragma once
/// What the examples of world/ take for granted.

#include <documentation/example_context.h>
#include <documentation/example_robots.h>
#include <documentation/example_world.h>
#include <locograph/common/simd_level.h>
#include <locograph/robots/robot.h>
#include <locograph/world/collision_world.h>
#include <locograph/world/convex_shape.h>
#include <locograph/world/distance_view.h>
#include <locograph/world/octree.h>
#include <locograph/world/perception/camera_noise.h>
#include <locograph/world/perception/configuration_buffer.h>
#include <locograph/world/perception/depth_image.h>
#include <locograph/world/perception/depth_png.h>
#include <locograph/world/perception/field_buffers.h>
#include <locograph/world/perception/local_map.h>
#include <locograph/world/perception/perception.h>
#include <locograph/world/perception/window_transform.h>
#include <locograph/world/point_cloud.h>
#include <locograph/world/proposed_effectors.h>
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
namespace effector_skin_h {
struct Context : in_world::Context {
  const EndEffector sole = proposed_effectors(robot).front();
};
}  // namespace effector_skin_h
namespace leftover_map_h {
struct Context : in_world::Context {
  World world = in_world::Context::world;
  const Surface surface = world.surfaces[1];
  const std::vector<Eigen::Vector3d> points = scanned_points();
  const std::vector<Bar> bars = world.bars;
};
}  // namespace leftover_map_h
namespace point_list_h {
struct Context : in_world::Context {
  const WorldDistance seen = distance_view(world);
  const std::vector<double> x = {0.0, 1.0}, y = x, z = x;
  std::vector<double> distances = x;
};
}  // namespace point_list_h
namespace distance_source_h {
struct Context : in_world::Context {
  LocalMap map;
  const std::shared_ptr<const DistanceSource> source = map.field();
};
}  // namespace distance_source_h
namespace bent_legs_h {
struct Context {
  const Robot& robot = *coman_plus();
};
}  // namespace bent_legs_h
namespace left_out_pairs_h {
struct Context {
  Robot robot = small_arm();
  static void taken_on_trust(int, int) {}
};
}  // namespace left_out_pairs_h
namespace link_pairs_h {
struct Context : in_world::Context {
  const Robot robot = small_arm();
};
}  // namespace link_pairs_h
/// A camera of CENTAURO, and an image of its.
struct CameraContext {
  const Robot& robot = *centauro();
  const DepthCamera camera = cameras_of(robot)[0];
  DepthImage image;
  const Eigen::VectorXd q = robot.named_configuration("home"), next_q = q;
  const Eigen::Isometry3d link_from_body = Eigen::Isometry3d::Identity();

  CameraContext() {
    write_room_files();
    image = depth_image_of(read_point_cloud("scan.pcd"), camera);
  }
  static void report(const std::string&) {}
};
namespace perception_clouds_folder_h {
struct Context : CameraContext {
  Context() {
    std::filesystem::create_directory("run_7");
    save_depth_png("run_7/0000.png", image, camera);
    write_example_file("run_7/clouds.csv", "time_s,camera,file\n0," + camera.name + ",0000.png\n");
  }
};
}  // namespace perception_clouds_folder_h
namespace perception_configuration_buffer_h {
using Context = CameraContext;
}
namespace perception_depth_camera_h {
struct Context : CameraContext {
  const Robot& robot = *coman_plus();
};
}  // namespace perception_depth_camera_h
namespace perception_depth_image_h {
using Context = CameraContext;
}
namespace perception_depth_png_h {
using Context = CameraContext;
}
/// A camera on the chest that looks down, and its image of the floor.
struct ChestCameraContext : in_world::Context {
  DepthCamera camera = chest_camera(robot);
  const Eigen::VectorXd configuration = standing(robot);
  RobotState state = state_at(robot, configuration);
  std::uint64_t seed = 1;
  std::vector<float> depth_m = std::vector<float>(64 * 48, 1.5f);
  DepthImage image{
      .width = 64, .height = 48, .depth_mm = std::vector<std::uint16_t>(64 * 48, 1500)},
      truth;
  const Eigen::Isometry3d optical_from_world =
      (state.world_from_link(camera.link) * camera.link_from_optical).inverse();
  const Eigen::Isometry3d optical_from_shape{Eigen::Translation3d(0.1, -0.2, 1.0)};

  static DepthCamera chest_camera(const Robot& robot) {
    DepthCamera camera;
    camera.name = "chest";
    camera.link = robot.link_index("DWYTorso");
    camera.link_from_optical.translate(Eigen::Vector3d(0.3, 0.0, 0.2));
    camera.link_from_optical.rotate(Eigen::AngleAxisd(2.6, Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(-M_PI_2, Eigen::Vector3d::UnitZ()));
    camera.width = 64;
    camera.height = 48;
    camera.fx = camera.fy = 34.0;
    camera.cx = 31.5;
    camera.cy = 23.5;
    return camera;
  }
  static Eigen::VectorXd standing(const Robot& robot) {
    Eigen::VectorXd configuration = robot.named_configuration("home");
    configuration[2] = 0.96;
    return configuration;
  }
  static void look(int, int, int) {}
};
namespace perception_camera_noise_h {
using Context = ChestCameraContext;
}
namespace perception_image_bounds_h {
using Context = ChestCameraContext;
}
namespace perception_ray_caster_h {
using Context = ChestCameraContext;
}
namespace perception_ray_entries_h {
using Context = ChestCameraContext;
}
namespace perception_ray_tile_h {
using Context = ChestCameraContext;
}
namespace perception_self_filter_h {
using Context = ChestCameraContext;
}
namespace perception_simulated_camera_h {
using Context = ChestCameraContext;
}
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
namespace perception_known_shapes_h {
struct Context : in_world::Context {
  World world;
  LocalMap map;
  const VoxelWindow& window = map.window();
  Context() { world.solids.push_back({.name = "step"}); }
};
}  // namespace perception_known_shapes_h
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
namespace point_cloud_h {
using Context = CameraContext;
}
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
namespace voxel_tree_h {
struct Context : in_world::Context {
  int leaves = 0;
};
}  // namespace voxel_tree_h

}  // namespace locograph::documentation::in_world
