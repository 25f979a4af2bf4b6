#pragma once
/// A room with walls, a table, poles, boxes and steps, and depth images of it: cast against the
/// shapes' equations, with the noise of a stereo camera. For tests and benchmarks of the local map.
///
///     RoomCamera room(7);                           // seed of the noise
///     room.solids.push_back(upright_cylinder(2.0, 0.5, 0.0, 1.9, 0.01));
///     DepthImage image = room.take(small_camera(), world_from_optical, stamp_s);

#include <locograph/world/perception/depth_camera.h>
#include <locograph/world/perception/depth_image.h>

#include <random>
#include <vector>

namespace locograph::test {

struct RoomSolid {
  enum class Kind { kBox, kUprightCylinder } kind = Kind::kBox;
  Eigen::Vector3d lower, upper;  ///< of a cylinder: the corners of the box around it
  /// Negative inside.
  double distance(const Eigen::Vector3d& point) const;
};

RoomSolid solid_box(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper);
RoomSolid upright_cylinder(double x, double y, double lower_z, double upper_z, double radius);

/// 87 x 58 degrees, 640 x 480 pixels; and the same with fewer pixels.
DepthCamera room_camera(int width = 640, int height = 480);
/// Looking along +x, turned by yaw to the left and by pitch down.
Eigen::Isometry3d looking(const Eigen::Vector3d& from, double yaw_rad, double pitch_rad);
/// A walk through the room, head (0) or pelvis (1), 30 images a second.
Eigen::Isometry3d walking_camera(int camera, double time_s);

class RoomCamera {
 public:
  explicit RoomCamera(unsigned seed) : generator_(seed) {}

  std::vector<RoomSolid> solids;
  bool has_floor = true;  ///< z = 0, without an end
  double noise = 1.0;     ///< times that of the camera: 0: none at all

  DepthImage take(const DepthCamera& camera, const Eigen::Isometry3d& world_from_optical,
                  double stamp_s);

 private:
  std::mt19937 generator_;
  std::vector<float> depth_;
};

/// The room of the benchmark.
std::vector<RoomSolid> furnished_room();

}  // namespace locograph::test
