#pragma once
/// KDL's tree of a robot, from urdfdom's reading of the URDF: nothing of it passes through ours.
///
///     urdf::ModelInterfaceSharedPtr source = parse_urdf("centauro.urdf");
///     KDL::Tree tree("pelvis");
///     add_children(*source->getLink("pelvis"), tree);

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <filesystem>
#include <fstream>
#include <kdl/frames.hpp>
#include <kdl/tree.hpp>
#include <sstream>

namespace locograph::test {

inline urdf::ModelInterfaceSharedPtr parse_urdf(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  console_bridge::noOutputHandler();
  const urdf::ModelInterfaceSharedPtr source = urdf::parseURDF(text.str());
  console_bridge::restorePreviousOutputHandler();
  return source;
}

inline KDL::Frame to_kdl(const urdf::Pose& pose) {
  return KDL::Frame(
      KDL::Rotation::Quaternion(pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w),
      KDL::Vector(pose.position.x, pose.position.y, pose.position.z));
}

inline KDL::Joint to_kdl(const urdf::Joint& joint, const KDL::Frame& origin) {
  const KDL::Vector axis = origin.M * KDL::Vector(joint.axis.x, joint.axis.y, joint.axis.z);
  if (joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS) {
    return KDL::Joint(joint.name, origin.p, axis, KDL::Joint::RotAxis);
  }
  if (joint.type == urdf::Joint::PRISMATIC) {
    return KDL::Joint(joint.name, origin.p, axis, KDL::Joint::TransAxis);
  }
  return KDL::Joint(joint.name, KDL::Joint::None);
}

inline KDL::RigidBodyInertia inertia_of(const urdf::Link& link) {
  if (!link.inertial) return KDL::RigidBodyInertia::Zero();
  const urdf::Inertial& inertial = *link.inertial;
  return to_kdl(inertial.origin) *
         KDL::RigidBodyInertia(inertial.mass, KDL::Vector::Zero(),
                               KDL::RotationalInertia(inertial.ixx, inertial.iyy, inertial.izz,
                                                      inertial.ixy, inertial.ixz, inertial.iyz));
}

/// Depth first: KDL's solvers copy the tree that way and number the joints anew.
inline void add_children(const urdf::Link& link, KDL::Tree& tree) {
  for (const urdf::LinkSharedPtr& child : link.child_links) {
    const urdf::Joint& joint = *child->parent_joint;
    const KDL::Frame origin = to_kdl(joint.parent_to_joint_origin_transform);
    tree.addSegment(KDL::Segment(child->name, to_kdl(joint, origin), origin, inertia_of(*child)),
                    link.name);
    add_children(*child, tree);
  }
}

}  // namespace locograph::test
