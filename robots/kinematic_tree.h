#pragma once
/// The moving bodies of a robot as flat arrays in topological order, fixed and frozen joints
/// folded.
///
///     const locograph::KinematicTree& tree = robot.tree();
///     int body = tree.body_of_link[robot.link_index("wheel_1")];
///
/// Body 0 is the root; body i + 1 is what axis i of the robot moves. Every link is fixed to one
/// body. The pose of a body is affine in two scalars of its joint, parent_from_body = A + u B + w
/// C, with (u, w) = (sin q, cos q) for rotations, from Rodrigues' formula R(a, q) = a a^T + sin q
/// [a] - cos q [a]^2, and (q, 0) for translations.

#include <locograph/robots/tree_kernels.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace locograph {

struct Axis;
struct Joint;
struct Link;

struct KinematicTree {
  struct Body {
    Eigen::Matrix4d A, B, C;
    Eigen::Vector4d axis;       ///< of its joint, body frame, last entry 0
    Eigen::Vector4d moment;     ///< mass * com in the body frame, last entry: mass [kg m, kg]
    int parent = -1;            ///< body index, smaller than its own
    bool revolute = true;       ///< else prismatic
    double subtree_mass = 0.0;  ///< kg
  };
  struct RigidLink {
    int link, body;
    Eigen::Matrix4d body_from_link;
  };

  std::vector<Body> bodies;
  std::vector<int> body_of_link;
  std::vector<int> link_of_body;       ///< the link whose frame is the body frame
  std::vector<RigidLink> rigid_links;  ///< links whose frame is not the body frame
  std::vector<int> support_begin;      ///< links + 1 offsets into support
  std::vector<int> support;            ///< axes from the root to each link

  /// The same for tree_kernels.h.
  std::vector<TreeAxis> flat_axes;
  std::vector<TreeLink> flat_links;

  Eigen::Isometry3d body_from_link(int link) const;

  static KinematicTree build(const std::vector<Link>& links, const std::vector<Joint>& joints,
                             const std::vector<Axis>& axes);
};

}  // namespace locograph
