#pragma once
/// Robots and cameras for the tests of what a camera sees.

#include <locograph/robots/robot.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/perception/depth_camera.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "common/temporary_folder.h"

namespace locograph::test {

/// With the field of view of a D435i.
inline DepthCamera small_camera(int width = 160, int height = 120) {
  DepthCamera camera;
  camera.name = "small";
  camera.width = width;
  camera.height = height;
  camera.fx = 0.5 * width / std::tan(0.5 * 87.0 * std::numbers::pi / 180.0);
  camera.fy = 0.5 * height / std::tan(0.5 * 58.0 * std::numbers::pi / 180.0);
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  return camera;
}

inline Eigen::Vector3d ray_of(const DepthCamera& camera, int pixel) {
  return {(pixel % camera.width - camera.cx) / camera.fx,
          (pixel / camera.width - camera.cy) / camera.fy, 1.0};
}

/// x forward, y left, z up in the frame that an optical frame is given in.
inline Eigen::Isometry3d looking(const Eigen::Vector3d& from, double down_rad) {
  Eigen::Matrix3d body_from_optical;
  body_from_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d pose(Eigen::Translation3d(from) *
                         Eigen::AngleAxisd(down_rad, Eigen::Vector3d::UnitY()));
  pose.rotate(body_from_optical);
  return pose;
}

/// A robot that comes with locograph.
inline Robot shipped(const std::string& name) {
  const std::string stem = LOCOGRAPH_SOURCE_DIR "/robots/models/" + name + "/" + name;
  return Robot::load(stem + ".urdf", stem + ".srdf");
}

/// A base without a shape, and an arm of one in front of it.
inline Robot robot_of_shapes(const TemporaryFolder& folder, const std::string& arm_geometry) {
  return Robot::load(folder.write("arm.urdf", R"(<robot name="arm"><link name="base"/>
  <link name="arm"><collision><origin xyz="0.2 0.1 -0.1" rpy="0.3 0.7 -0.4"/><geometry>)" +
                                                  arm_geometry + R"(</geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="arm"/>
    <origin xyz="1.5 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" velocity="1" effort="10"/></joint></robot>)"));
}

/// At home, the base so high that the feet or wheels touch the ground.
inline Eigen::VectorXd standing(const Robot& robot, double base_height_m) {
  Eigen::VectorXd configuration = robot.named_configuration("home");
  configuration[2] = base_height_m;
  return configuration;
}

}  // namespace locograph::test
