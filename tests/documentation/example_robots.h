#pragma once
/// The shipped robots that examples are run with, each loaded once, at home with its feet or wheels
/// near the ground; and a mesh.

#include <documentation/example_context.h>
#include <locograph/robots/robot.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/shipped_robot.h>

namespace locograph::documentation {

inline std::shared_ptr<const Robot> load_shipped(const std::string& name) {
  const RobotFiles files = shipped_robot(name).value();
  return std::make_shared<const Robot>(Robot::load(files.urdf, files.srdf));
}
inline const std::shared_ptr<const Robot>& centauro() {
  static const std::shared_ptr<const Robot> robot = load_shipped("centauro");
  return robot;
}
inline const std::shared_ptr<const Robot>& coman_plus() {
  static const std::shared_ptr<const Robot> robot = load_shipped("coman_plus");
  return robot;
}

inline RobotState state_at(const Robot& robot, const Eigen::VectorXd& configuration) {
  RobotState state(robot);
  state.update(configuration.data());
  return state;
}

inline std::vector<Eigen::Isometry3d> link_poses(const RobotState& state) {
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t link = 0; link < state.robot().links().size(); ++link) {
    poses.push_back(state.world_from_link(static_cast<int>(link)));
  }
  return poses;
}

/// The files of a robot, in the folder of the example.
inline void copy_shipped_robot(const std::string& name) {
  const RobotFiles files = shipped_robot(name).value();
  std::filesystem::copy_file(files.urdf, name + ".urdf");
  std::filesystem::copy_file(files.srdf, name + ".srdf");
}

/// Three spheres, for examples that would take minutes with a real robot under sanitizers.
inline Robot small_arm() {
  write_example_file("arm.urdf", R"(<robot name="arm">
  <link name="base"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0 0 0.3"/>
    <geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0 0 0.3"/>
    <geometry><box size="0.1 0.1 0.2"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <axis xyz="0 1 0"/><limit lower="-2" upper="2" velocity="1" effort="10"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/>
    <origin xyz="0 0 0.3"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" velocity="1" effort="10"/></joint>
</robot>)");
  return Robot::load("arm.urdf");
}

/// A tetrahedron of some 30 cm.
inline constexpr std::string_view kTetrahedron =
    "solid tetrahedron\n"
    "facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 0.3 0 vertex 0.3 0 0 endloop endfacet\n"
    "facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0.3 0 0 vertex 0 0 0.3 endloop endfacet\n"
    "facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 0 0.3 vertex 0 0.3 0 endloop endfacet\n"
    "facet normal 0 0 0 outer loop vertex 0.3 0 0 vertex 0 0.3 0 vertex 0 0 0.3 endloop endfacet\n"
    "endsolid\n";

}  // namespace locograph::documentation
