#pragma once
/// What each pixel of a depth camera meets first: the solids of a world where they are at a time,
/// and the robot that carries the camera.
///
///     RayCaster rays(robot, world);
///     FirstHits hits;
///     rays.cast(camera, state, time_s, hits);
///     const Shown shown = rays.shown(hits.shows[0]);      // in the upper left corner
///     if (shown.kind == Shown::Kind::kObstacle) report(shown.name, "is in sight");
///
/// By exact shapes, the ones that the judge measures (world_solids.h): obstacles at their poses,
/// surfaces (a plate with an end is 0.2 mm thick), bars, boxes, the occupied leaves of the map; and
/// the collision shapes of all links, of meshes their triangles. A solid that the optical centre
/// lies in is not seen: the camera's own housing, or the ground from below.
///
/// Pixels are cast in tiles, each against what may show in it and is not hidden. Deterministic,
/// whatever the number of threads. Thread-safety: one per thread.

#include <locograph/common/thread_pool.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/perception/depth_camera.h>
#include <locograph/world/world.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace locograph {

/// What a pixel shows.
struct Shown {
  enum class Kind { kNothing, kLink, kObstacle, kSurface, kBar, kSolid, kMap };

  Kind kind = Kind::kNothing;
  int index = -1;    ///< of the robot's links, or of the world's list of its kind
  std::string name;  ///< "" for nothing, "map"
};

struct FirstHits {
  std::vector<float> depth_m;  ///< row by row along the optical z; infinite: nothing in range
  std::vector<std::int16_t>
      shows;  ///< a link by its index, others: RayCaster::shown(); -1: nothing
};

class RayCaster {
 public:
  /// Throws Error for shapes that cannot be used, and for more of them than can be told apart.
  RayCaster(const Robot& robot, const World& world, int threads = 1);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// Up to the end of the camera's range, and also what is nearer than its beginning. Throws Error
  /// for a camera that cannot be used or is not on this robot, and for a state of another robot.
  void cast(const DepthCamera& camera, const RobotState& state, double time_s, FirstHits& hits);

  Shown shown(int number) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace locograph
