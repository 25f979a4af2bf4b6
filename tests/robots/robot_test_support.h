#pragma once
/// What the robot tests share: the public robots, random configurations.

#include <gtest/gtest.h>
#include <locograph/robots/robot.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "common/temporary_folder.h"

namespace locograph::test {

inline std::filesystem::path public_robot(const std::string& file) {
  return std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "robots" / file;
}

inline std::filesystem::path model(const std::string& file) {
  return std::filesystem::path(LOCOGRAPH_SOURCE_DIR) / "robots" / "models" / file;
}

inline const std::vector<std::string>& public_robots() {
  static const std::vector<std::string> names = {
      "centauro", "centauro_capsule", "cogimon", "anymal", "go2", "simple_humanoid"};
  return names;
}

/// Unit-quaternion base anywhere within 2 m, joints within their limits (continuous: +-pi).
inline Eigen::VectorXd random_configuration(const Robot& robot, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::normal_distribution<double> normal;
  Eigen::VectorXd q(robot.configuration_size());
  if (robot.floating_base()) {
    q.head<3>() << 2.0 * unit(random), 2.0 * unit(random), 2.0 * unit(random);
    q.segment<4>(3) << normal(random), normal(random), normal(random), normal(random);
    q.segment<4>(3).normalize();
  }
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const Joint& joint = robot.active_joint(i);
    const bool limited = joint.type != JointType::kContinuous;
    const double lower = limited ? joint.lower : -3.14159;
    const double upper = limited ? joint.upper : 3.14159;
    q[robot.base_configuration_size() + i] = lower + (upper - lower) * 0.5 * (1.0 + unit(random));
  }
  return q;
}

inline Eigen::VectorXd random_vector(int size, double scale, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-scale, scale);
  Eigen::VectorXd v(size);
  for (int i = 0; i < size; ++i) v[i] = unit(random);
  return v;
}

/// One revolute, one prismatic and one fixed joint; a mass on each link.
inline std::string small_robot_urdf() {
  return R"(<robot name="small">
  <link name="base"><inertial><mass value="3"/><origin xyz="0.1 0 0"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="arm"><inertial><mass value="2"/><origin xyz="0 0.2 0" rpy="0.3 0.1 -0.4"/>
    <inertia ixx="1" ixy="0.1" ixz="0" iyy="2" iyz="0" izz="3"/></inertial></link>
  <link name="slide"><inertial><mass value="1"/><origin xyz="0 0 0.3"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="tip"/>
  <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
    <origin xyz="0.3 0 0.1" rpy="0.1 0.2 0.3"/><axis xyz="0 3 4"/>
    <limit lower="0.5" upper="2" velocity="1.5" effort="20"/></joint>
  <joint name="push" type="prismatic"><parent link="arm"/><child link="slide"/>
    <origin xyz="0 0.4 0"/><axis xyz="1 0 1"/>
    <limit lower="-0.2" upper="0.4" velocity="0.5" effort="30"/></joint>
  <joint name="tip_joint" type="fixed"><parent link="slide"/><child link="tip"/>
    <origin xyz="0 0 0.2" rpy="0 0.5 0"/></joint>
</robot>
)";
}

}  // namespace locograph::test
