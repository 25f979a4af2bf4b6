#pragma once
/// A depth camera on a link of the robot: where it looks from, its pixels and its range.
///
///     DepthCamera camera = depth_camera("head", link, 640, 480, 1.518);
///     camera.validate();

#include <locograph/robots/robot.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace locograph {

struct DepthCamera {
  std::string name;
  int link = 0;  ///< of the robot
  /// z forward, x right, y down.
  Eigen::Isometry3d link_from_optical = Eigen::Isometry3d::Identity();
  int width = 640, height = 480;
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  ///< pixels; pixel centres at integers
  double range_min_m = 0.3, range_max_m = 6.0;    ///< along the optical z
  void validate() const;                          ///< throws Error
};

/// Square pixels, the axis through the middle of the image.
DepthCamera depth_camera(std::string name, int link, int width, int height, double fov_x_rad);
std::vector<DepthCamera> cameras_of(const Robot& robot);

}  // namespace locograph
