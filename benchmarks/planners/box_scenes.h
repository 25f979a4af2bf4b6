#pragma once
/// CENTAURO's drive in a walled corridor with a box at random in it.
///
///     BoxDrives drives;
///     const BoxScene scene = draw_box_scene(random);
///     if (drives.usable(scene)) drive_past(drives.motion(), drives.world_of(scene, true));

#include <locograph/check/motion.h>
#include <locograph/planners/task/task.h>
#include <locograph/world/world.h>

#include <random>

namespace locograph {

struct BoxScene {
  double x, y, side, height;  ///< of the box, standing on the ground
  double gap;                 ///< between the box and the farther wall
  double wall;                ///< the walls' faces are at y = ±wall
};

BoxScene draw_box_scene(std::mt19937_64& random);

class BoxDrives {
 public:
  BoxDrives();

  const Task& task() const { return task_; }
  const Motion& motion() const { return motion_; }  ///< as it is planned, in an empty world

  /// False when the box stands where the robot starts or is to end.
  bool usable(const BoxScene& scene) const;
  /// The box, and the walls, as voxels.
  World world_of(const BoxScene& scene, bool with_walls, bool with_box = true) const;

 private:
  Task task_;
  Motion motion_;
};

}  // namespace locograph
