#pragma once
/// Obstacles given as primitives (box, sphere, cylinder), at rest or moving along key frames.
///
///     for (const locograph::Obstacle& obstacle : locograph::load_obstacles("obstacles.xml")) {
///       double d = obstacle.distance(point, time_s);  // exact, negative inside
///     }
///
/// The file (metres, seconds, radians; rpy = roll, pitch, yaw as in URDF: R = Rz(y) Ry(p) Rx(r)):
///
///   <obstacles version="1">
///     <box name="door" center="1 0 1" size="0.1 0.9 2" rpy="0 0 0.3"/>
///     <sphere name="ball" center="2 0 0.2" radius="0.2"/>
///     <cylinder name="pillar" center="3 1 1" radius="0.15" height="2"/>
///     <box name="cart" center="2 -1 0.5" size="0.6 0.4 1" repeat="10">
///       <keyframe time="5" position="2 1 0.5" rpy="0 0 1.57"/>
///     </box>
///   </obstacles>
///
/// `center` and `rpy` are the pose at time 0; each key frame gives the pose at a later time, and in
/// between the position is linear and the orientation turns at constant rate about one axis. A key
/// frame without `rpy` keeps the orientation of the one before. After the last key frame the
/// obstacle stays; with `repeat` (a period longer than the last time) it returns to its first pose
/// at the end of the period and starts again. An obstacle is there from `appears` to `vanishes`
/// (seconds, both included; each optional: it has always been there, it stays), whatever its motion
/// does meanwhile: `<box appears="3" vanishes="9" ...>`. `rpy` may be replaced by `rotation`, the
/// nine entries of the rotation matrix row by row, which is how orientations are saved that rpy
/// would round. Names are optional and unique if present. Any mistake throws Error with file and
/// line.

#include <locograph/world/distance_sample.h>
#include <locograph/world/point_list.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace locograph {

struct KeyFrame {
  double time_s = 0.0;                                     ///< > 0, increasing
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< world_from_obstacle then
};

struct Obstacle {
  enum class Shape { kBox, kSphere, kCylinder };

  Shape shape = Shape::kBox;
  std::string name;
  Eigen::Isometry3d world_from_obstacle = Eigen::Isometry3d::Identity();  ///< at time 0
  /// Box: extents. Sphere: (radius, 0, 0). Cylinder about z: (radius, height, 0).
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
  std::vector<KeyFrame> motion;  ///< after time 0; empty: at rest
  double repeat_s = 0.0;         ///< period; 0: the motion happens once
  /// It is there from the one time to the other, both included; infinite: always.
  double appears_s = -std::numeric_limits<double>::infinity();
  double vanishes_s = std::numeric_limits<double>::infinity();

  bool is_there(double time_s) const { return appears_s <= time_s && time_s <= vanishes_s; }
  /// At some time between these, in either order.
  bool is_there(double from_s, double to_s) const {
    return appears_s <= std::max(from_s, to_s) && std::min(from_s, to_s) <= vanishes_s;
  }

  /// Pose at a time [s]; times before 0 give the pose at 0.
  Eigen::Isometry3d pose_at(double time_s) const;

  /// Exact signed distance to the surface [m], and its gradient (a unit vector; where it is not
  /// unique, e.g. at the centre of a sphere, one of the possible ones). Where the obstacle is not
  /// there, infinity and zero.
  DistanceSample sample(const Eigen::Vector3d& point, double time_s) const;
  double distance(const Eigen::Vector3d& point, double time_s) const {
    return sample(point, time_s).distance;
  }

  /// The same of its shape at its pose, whether it is there or not.
  DistanceSample sample_shape(const Eigen::Vector3d& point, double time_s) const;
  /// nearest[i] = min(nearest[i], sample_shape(point i).distance) up to rounding, several points at
  /// a time.
  void lower_to_shape(const PointList& points, double time_s, double* nearest) const;

  /// Throws Error when a size is not positive and finite, a pose is not finite or not a rotation,
  /// times do not increase, or the obstacle vanishes before it appears.
  void validate() const;
};

std::vector<Obstacle> load_obstacles(const std::filesystem::path& path);

/// Writes what load_obstacles reads back bit by bit, through a temporary file that is renamed.
void save_obstacles(std::span<const Obstacle> obstacles, const std::filesystem::path& path);

}  // namespace locograph
