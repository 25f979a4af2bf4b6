#pragma once
/// A depth camera on a link of a robot: where it is, its pixels, and the depths that it can see.
///
///     DepthCamera camera = depth_camera("belt", robot.link_index("Waist"), 640, 480, 1.2);
///     camera.link_from_optical = link_from_body * body_from_optical();
///     camera.validate();
///     const Eigen::Vector3d point = camera.point(320, 240, 1.5);   // in the optical frame [m]
///
/// The optical frame has z forward, x right and y down in the image (REP 103). The centre of pixel
/// (u, v), column and row from the upper left one, which is (0, 0), sees along
/// ((u - cx) / fx, (v - cy) / fy, 1). There is no distortion.

#include <locograph/robots/robot.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace locograph {

struct DepthCamera {
  static constexpr int kMostPixels = 4096;  ///< along each side

  std::string name;
  int link = 0;  ///< of the robot
  Eigen::Isometry3d link_from_optical = Eigen::Isometry3d::Identity();
  int width = 640, height = 480;
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  ///< pixels
  double range_min_m = 0.3, range_max_m = 6.0;    ///< along the optical z

  /// What pixel (u, v) shows at this depth along z [m].
  Eigen::Vector3d point(double u, double v, double depth_m) const {
    return {(u - cx) / fx * depth_m, (v - cy) / fy * depth_m, depth_m};
  }

  /// Throws Error for one without a name, without pixels or with more than kMostPixels, with
  /// numbers that are not finite, focal lengths that are not positive, a pose that is none, or a
  /// range_min_m that is negative or not below range_max_m. Whether the link exists stays open.
  void validate() const;
};

/// With square pixels, the optical axis in the middle of the image, and fov_x_rad between the outer
/// edges of its first and last columns. Throws Error for what validate() refuses, and for an angle
/// that is not between 0 and pi.
DepthCamera depth_camera(std::string name, int link, int width, int height, double fov_x_rad);

/// The optical frame in one whose x is forward and z up, as links of cameras are (REP 103).
Eigen::Isometry3d body_from_optical();

/// The robot's own: one on each link called NAME_depth_optical_frame, whose frame is its optical
/// one, with the figures of a D435i: 640 x 480 pixels, 87 x 58 degrees, 0.3 to 6 m.
std::vector<DepthCamera> cameras_of(const Robot& robot);

}  // namespace locograph
