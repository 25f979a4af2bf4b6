#pragma once
/// A cart with one wheel that turns, a lift that slides, an arm, and a mast that does neither.
/// Active joints: arm, lift, wheel_joint, frozen in no state. Three collision spheres.

namespace locograph::test {

inline constexpr const char* kCartUrdf = R"(<robot name="cart">
  <link name="base"><collision><geometry><sphere radius="0.2"/></geometry></collision></link>
  <link name="arm"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="lift"/>
  <link name="wheel"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="mast"/>
  <joint name="arm_joint" type="revolute"><parent link="base"/><child link="arm"/>
    <origin xyz="0 0 0.5"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="2" velocity="1" effort="1"/></joint>
  <joint name="lift_joint" type="prismatic"><parent link="base"/><child link="lift"/>
    <axis xyz="0 0 1"/><limit lower="0" upper="0.5" velocity="0.2" effort="1"/></joint>
  <joint name="wheel_joint" type="continuous"><parent link="base"/><child link="wheel"/>
    <origin xyz="0.3 0 -0.1"/><axis xyz="0 1 0"/><limit velocity="8" effort="1"/></joint>
  <joint name="mast_joint" type="fixed"><parent link="base"/><child link="mast"/></joint>
</robot>
)";

inline constexpr const char* kCartSrdf = R"(<robot name="cart">
  <group name="limb"><joint name="arm_joint"/></group>
  <group_state name="home" group="limb"><joint name="arm_joint" value="0.25"/></group_state>
  <group_state name="raised" group="limb"><joint name="arm_joint" value="1.5"/></group_state>
</robot>
)";

}  // namespace locograph::test
