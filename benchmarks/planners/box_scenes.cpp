#include "planners/box_scenes.h"

#include <locograph/check/judge.h>
#include <locograph/common/uniform.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>
#include <locograph/world/octree.h>

#include <cmath>
#include <vector>

namespace locograph {
namespace {

constexpr double kRobotWidth_m = 0.966;
constexpr double kResolution_m = 0.05;
constexpr double kWallHeight_m = 1.2, kWallThickness_m = 0.2;

Box box(const Eigen::Vector3d& centre, const Eigen::Vector3d& size) {
  Box result;
  result.world_from_box.translation() = centre;
  result.size = size;
  return result;
}

}  // namespace

BoxScene draw_box_scene(std::mt19937_64& random) {
  BoxScene scene;
  scene.x = uniform(random, 1.4, 2.8);
  scene.y = uniform(random, -0.6, 0.6);
  scene.side = uniform(random, 0.2, 0.7);
  scene.height = uniform(random, 0.3, 1.0);
  scene.gap = kRobotWidth_m + uniform(random, 0.3, 0.6);
  scene.wall = scene.gap + 0.5 * scene.side - std::abs(scene.y);
  return scene;
}

BoxDrives::BoxDrives()
    : task_(task_of(load_scenario(LOCOGRAPH_SOURCE_DIR "/planners/scenarios/centauro_drive.xml",
                                  LOCOGRAPH_SOURCE_DIR))),
      motion_(plan_wheeled_drive(task_).motion) {}

bool BoxDrives::usable(const BoxScene& scene) const {
  const Judge judge(task_.robot->robot, world_of(scene, false));
  const CheckOptions options{.known = task_.end_effectors()};
  for (const Eigen::VectorXd& q : {motion_.configurations.front(), motion_.configurations.back()}) {
    if (judge.check(q, motion_.stances.front(), options).constraint("obstacle_distance").violated) {
      return false;
    }
  }
  return true;
}

World BoxDrives::world_of(const BoxScene& scene, bool with_walls, bool with_box) const {
  std::vector<Box> boxes;
  if (with_box) {
    boxes.push_back(
        box({scene.x, scene.y, 0.5 * scene.height}, {scene.side, scene.side, scene.height}));
  }
  for (const double sign : {-1.0, 1.0}) {
    if (!with_walls) break;
    boxes.push_back(box({2.0, sign * (scene.wall + 0.5 * kWallThickness_m), 0.5 * kWallHeight_m},
                        {8.0, kWallThickness_m, kWallHeight_m}));
  }
  World world = task_.world->world();
  world.map = octree_from_boxes(boxes, kResolution_m);
  return world;
}

}  // namespace locograph
