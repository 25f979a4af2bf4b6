#pragma once
/// What the tests of perception share: a ball with a camera that looks ahead, and images of a wall.
///
///     const auto robot = camera_robot();
///     Perception perception(robot, {small_camera(*robot)}, {});
///     perception.image(wall_image(0.1, 1.5));

#include <locograph/robots/robot.h>
#include <locograph/world/perception/depth_camera.h>
#include <locograph/world/perception/depth_image.h>

#include <memory>
#include <vector>

#include "common/temporary_folder.h"

namespace locograph::test {

inline constexpr int kWidth = 80, kHeight = 60;

/// The camera is in the ball's middle, and looks along x.
inline std::shared_ptr<const Robot> camera_robot() {
  const TemporaryFolder folder;
  return std::make_shared<const Robot>(
      Robot::load(folder.write("ball.urdf", R"(<robot name="ball"><link name="ball">
  <inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  <collision><geometry><sphere radius="0.1"/></geometry></collision></link></robot>)")));
}

inline DepthCamera small_camera(const Robot& robot) {
  DepthCamera camera = depth_camera("eye", robot.root_link(), kWidth, kHeight, 1.2);
  // z of the optical frame along x, x to the right, y down.
  camera.link_from_optical.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  camera.range_min_m = 0.05;
  return camera;
}

/// At x, z = 1; the identity otherwise.
inline Eigen::VectorXd standing_at(const Robot& robot, double x) {
  Eigen::VectorXd q = robot.neutral_configuration();
  q[0] = x;
  q[2] = 1.0;
  return q;
}

/// All pixels show a wall so far ahead, or nothing.
inline DepthImage wall_image(double stamp_s, double ahead_m) {
  DepthImage image;
  image.stamp_s = stamp_s;
  image.width = kWidth;
  image.height = kHeight;
  image.depth_mm.assign(static_cast<std::size_t>(kWidth * kHeight),
                        static_cast<std::uint16_t>(1000.0 * ahead_m));
  return image;
}

}  // namespace locograph::test
