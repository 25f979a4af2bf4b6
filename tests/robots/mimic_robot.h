#pragma once
/// A robot with mimic joints, as text.
///
///     const Robot robot = Robot::load(folder.write("mimic.urdf", mimic_robot_urdf()));

#include <string>

namespace locograph::test {

/// An arm whose elbow and wrist follow the shoulder, the wrist by way of the elbow, with a gripper
/// of two slides and a thumb that turns with them. Mimic joints stand before and after their
/// leader.
inline std::string mimic_robot_urdf() {
  return R"(<robot name="gripper">
  <link name="base"><inertial><mass value="4"/><origin xyz="0.1 0 0.05"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1.2" iyz="0" izz="1.4"/></inertial>
    <collision><origin xyz="0 0 0.05"/><geometry><sphere radius="0.08"/></geometry></collision></link>
  <link name="upper"><inertial><mass value="2"/><origin xyz="0 0.02 0.15"/>
    <inertia ixx="0.2" ixy="0" ixz="0" iyy="0.3" iyz="0" izz="0.2"/></inertial></link>
  <link name="lower"><inertial><mass value="1.5"/><origin xyz="0.12 0 0"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.15" iyz="0" izz="0.12"/></inertial>
    <collision><origin xyz="0.1 0 0"/><geometry><sphere radius="0.05"/></geometry></collision></link>
  <link name="hand"><inertial><mass value="0.8"/><origin xyz="0.05 0.01 0"/>
    <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.02"/></inertial></link>
  <link name="right"><inertial><mass value="0.2"/><origin xyz="0.02 0 0"/>
    <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial>
    <collision><origin xyz="0.02 0 0"/><geometry><sphere radius="0.015"/></geometry></collision></link>
  <link name="left"><inertial><mass value="0.2"/><origin xyz="0.02 0 0.01"/>
    <inertia ixx="0.001" ixy="0" ixz="0" iyy="0.001" iyz="0" izz="0.001"/></inertial>
    <collision><origin xyz="0.02 0 0"/><geometry><sphere radius="0.015"/></geometry></collision></link>
  <link name="thumb"><inertial><mass value="0.1"/><origin xyz="0.03 0 0"/>
    <inertia ixx="0.0005" ixy="0" ixz="0" iyy="0.0006" iyz="0" izz="0.0007"/></inertial>
    <collision><origin xyz="0.04 0 0"/><geometry><sphere radius="0.01"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0.1 0 0.2" rpy="0.1 0.2 0.3"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1.5" velocity="2" effort="500"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/>
    <origin xyz="0 0 0.3" rpy="0 -0.4 0"/><axis xyz="0 0.6 0.8"/>
    <limit lower="-1.5" upper="2.5" velocity="2" effort="1"/>
    <mimic joint="shoulder" multiplier="2" offset="0.1"/></joint>
  <joint name="wrist" type="continuous"><parent link="lower"/><child link="hand"/>
    <origin xyz="0.25 0 0" rpy="0.5 0 0"/><axis xyz="1 0 0"/>
    <mimic joint="elbow" multiplier="-0.5" offset="0.2"/></joint>
  <joint name="slide_right" type="prismatic"><parent link="hand"/><child link="right"/>
    <origin xyz="0.1 -0.02 0"/><axis xyz="0 1 0"/>
    <limit lower="-0.03" upper="0" velocity="0.2" effort="1"/>
    <mimic joint="slide_left" multiplier="-1"/></joint>
  <joint name="slide_left" type="prismatic"><parent link="hand"/><child link="left"/>
    <origin xyz="0.1 0.02 0"/><axis xyz="0 1 0"/>
    <limit lower="0" upper="0.05" velocity="0.2" effort="200"/></joint>
  <joint name="thumb_turn" type="revolute"><parent link="left"/><child link="thumb"/>
    <origin xyz="0.04 0 0" rpy="0 0 0.2"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="100" effort="1"/>
    <mimic joint="slide_left" multiplier="30" offset="-0.5"/></joint>
</robot>
)";
}

}  // namespace locograph::test
