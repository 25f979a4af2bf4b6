#pragma once
/// Links and joints of a URDF file, root first, depth first, before any joint is chosen or frozen.
///
///     locograph::UrdfModel model = locograph::read_urdf("centauro.urdf");
///
/// joints[i].index is -1 and frozen_position 0 throughout. Mimic joints and the limits of their
/// leaders are resolved (mimic_joints.h).

#include <locograph/robots/robot.h>

#include <filesystem>
#include <string>
#include <vector>

namespace locograph {

// Robots have up to a hundred links; the work grows with the pairs of them.
constexpr std::size_t kMostLinks = 2000;

struct UrdfModel {
  std::string name;
  std::vector<Link> links;
  std::vector<Joint> joints;
  std::vector<int> joint_lines;       ///< of the <joint> elements
  std::vector<std::string> warnings;  ///< Robot::urdf_warnings()
};

/// Throws Error with the line of the first element that makes the file unusable.
UrdfModel read_urdf(const std::filesystem::path& file);

/// A cylinder and two spheres of its radius around the centres of its ends become one capsule in
/// the cylinder's place; the other shapes stay as they are. Centres may be off by 0.1 mm.
std::vector<CollisionShape> merge_capsules(const std::vector<CollisionShape>& shapes);

/// Folders of packages, or packages themselves, in the order in which they are looked into: those
/// of the environment's LOCOGRAPH_PACKAGE_PATH, then of ROS_PACKAGE_PATH, separated by ':'.
std::vector<std::filesystem::path> package_folders();

/// Where a URDF's mesh reference points to: `package://NAME/PATH` is looked for as NAME/PATH and as
/// PATH in the folder of the URDF and all folders above it, then as NAME/PATH in package_folders(),
/// and as PATH in those that are called NAME. Empty if there is no such file.
std::filesystem::path find_mesh(const std::string& reference, const std::filesystem::path& urdf);

}  // namespace locograph
