#pragma once
/// A room that examples are run in: a floor, a step, a bar, a box, a map and a cart that moves; and
/// files of such things.

#include <documentation/example_context.h>
#include <documentation/example_robots.h>
#include <locograph/world/octree.h>
#include <locograph/world/world.h>

#include <numbers>
#include <sstream>

namespace locograph::documentation {

inline World small_room() {
  World world;
  Box wall;
  wall.world_from_box.translation() = Eigen::Vector3d(2.0, 0.0, 0.5);
  wall.size = Eigen::Vector3d(0.2, 1.0, 1.0);
  world.map = octree_from_boxes({&wall, 1}, 0.05);
  Obstacle cart;
  cart.name = "cart";
  cart.world_from_obstacle.translation() = Eigen::Vector3d(1.0, 2.0, 0.5);
  cart.size = Eigen::Vector3d(0.4, 0.4, 1.0);
  cart.motion = {{.time_s = 5.0, .pose = Eigen::Isometry3d(Eigen::Translation3d(1.0, -2.0, 0.5))}};
  world.obstacles = {cart};
  Surface step{.name = "step", .half_x_m = 0.3, .half_y_m = 0.4, .friction = 0.7};
  step.world_from_surface.translation() = Eigen::Vector3d(1.0, 0.0, 0.2);
  world.surfaces = {ground(), step};
  world.bars = {
      {.name = "rail", .from = {0.8, -0.5, 1.0}, .to = {0.8, 0.5, 1.0}, .radius_m = 0.02}};
  SolidBox block{.name = "block", .size_m = {0.6, 0.8, 0.2}};
  block.world_from_box.translation() = Eigen::Vector3d(1.0, 0.0, 0.1);
  world.solids = {block};
  return world;
}

/// Of a level square metre and a bar above it, 2 cm apart.
inline std::vector<Eigen::Vector3d> scanned_points() {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= 50; ++i) {
    for (int k = 0; k <= 50; ++k) points.emplace_back(0.02 * i, 0.02 * k, 0.0);
    for (int k = 0; k < 16; ++k) {
      const double angle = std::numbers::pi * k / 8.0;
      points.emplace_back(0.5 + 0.03 * std::cos(angle), 0.02 * i, 0.8 + 0.03 * std::sin(angle));
    }
  }
  return points;
}

inline void write_room_files() {
  const World room = small_room();
  save_octree(*room.map, "hall.bt");
  for (const char* file : {"boxes.xml", "obstacles.xml"}) save_obstacles(room.obstacles, file);
  for (const char* file : {"thigh.stl", "rocks.stl"}) write_example_file(file, kTetrahedron);
  const std::vector<Eigen::Vector3d> points = scanned_points();
  std::ostringstream scan;
  scan << "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " << points.size()
       << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << points.size() << "\nDATA ascii\n";
  for (const Eigen::Vector3d& point : points) scan << point.transpose() << '\n';
  write_example_file("scan.pcd", scan.str());
}

}  // namespace locograph::documentation
