#include <locograph/common/skew.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/robot.h>

#include <algorithm>

namespace locograph {
namespace {

KinematicTree::Body moving_body(const Joint& joint, const Eigen::Isometry3d& body_from_parent_link,
                                int parent) {
  KinematicTree::Body body;
  const Eigen::Matrix4d fixed = (body_from_parent_link * joint.parent_from_joint).matrix();
  Eigen::Matrix4d a = Eigen::Matrix4d::Identity(), b = Eigen::Matrix4d::Zero(), c = b;
  body.revolute = joint.type != JointType::kPrismatic;
  if (body.revolute) {
    const Eigen::Matrix3d k = skew(joint.axis);
    a.topLeftCorner<3, 3>() = joint.axis * joint.axis.transpose();
    b.topLeftCorner<3, 3>() = k;
    c.topLeftCorner<3, 3>() = -k * k;
  } else {
    b.topRightCorner<3, 1>() = joint.axis;
  }
  body.A = fixed * a;
  body.B = fixed * b;
  body.C = fixed * c;
  body.axis << joint.axis, 0.0;
  body.parent = parent;
  return body;
}

/// Pose of a fixed or frozen joint's child link in its parent link.
Eigen::Isometry3d frozen_pose(const Joint& joint) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  if (joint.type == JointType::kPrismatic) {
    motion.translation() = joint.frozen_position * joint.axis;
  } else if (joint.type != JointType::kFixed) {
    motion.linear() = Eigen::AngleAxisd(joint.frozen_position, joint.axis).toRotationMatrix();
  }
  return joint.parent_from_joint * motion;
}

void copy_rows(const Eigen::Matrix4d& from, double (&to)[12]) {
  Eigen::Map<Eigen::Matrix<double, 3, 4>>(to, 3, 4) = from.topRows<3>();
}

TreeAxis flat(const KinematicTree& tree, const KinematicTree::Body& body, const Axis& axis,
              int link) {
  TreeAxis flat{};
  copy_rows(body.A, flat.a);
  copy_rows(body.B, flat.b);
  copy_rows(body.C, flat.c);
  std::copy_n(body.axis.data(), 3, flat.axis);
  std::copy_n(body.moment.data(), 3, flat.moment);
  flat.mass = body.moment[3];
  flat.subtree_mass = body.subtree_mass;
  flat.multiplier = axis.multiplier;
  flat.offset = axis.offset;
  flat.active = axis.active;
  flat.parent_body = body.parent;
  flat.parent_link = tree.link_of_body[static_cast<std::size_t>(body.parent)];
  flat.link = link;
  flat.revolute = body.revolute;
  return flat;
}

}  // namespace

KinematicTree KinematicTree::build(const std::vector<Link>& links, const std::vector<Joint>& joints,
                                   const std::vector<Axis>& axes) {
  KinematicTree tree;
  const std::size_t link_count = links.size();
  std::vector<Eigen::Isometry3d> body_from_link(link_count, Eigen::Isometry3d::Identity());
  std::vector<std::vector<int>> support(link_count);
  tree.body_of_link.assign(link_count, 0);

  Body root;
  root.A = Eigen::Matrix4d::Identity();
  root.B = root.C = Eigen::Matrix4d::Zero();
  root.axis.setZero();
  tree.bodies.push_back(root);
  tree.link_of_body.push_back(0);

  for (std::size_t l = 1; l < link_count; ++l) {
    const Joint& joint = joints[static_cast<std::size_t>(links[l].parent_joint)];
    const std::size_t parent_link = static_cast<std::size_t>(joint.parent_link);
    const int parent_body = tree.body_of_link[parent_link];
    support[l] = support[parent_link];
    const std::size_t axis = tree.bodies.size() - 1;
    if (axis < axes.size() && axes[axis].joint == links[l].parent_joint) {
      tree.body_of_link[l] = static_cast<int>(tree.bodies.size());
      tree.bodies.push_back(moving_body(joint, body_from_link[parent_link], parent_body));
      tree.link_of_body.push_back(static_cast<int>(l));
      support[l].push_back(static_cast<int>(axis));
    } else {
      tree.body_of_link[l] = parent_body;
      body_from_link[l] = body_from_link[parent_link] * frozen_pose(joint);
      tree.rigid_links.push_back({static_cast<int>(l), parent_body, body_from_link[l].matrix()});
    }
  }

  for (Body& body : tree.bodies) body.moment.setZero();
  for (std::size_t l = 0; l < link_count; ++l) {
    Eigen::Vector4d moment;
    moment << links[l].mass * (body_from_link[l] * links[l].com), links[l].mass;
    tree.bodies[static_cast<std::size_t>(tree.body_of_link[l])].moment += moment;
  }
  for (Body& body : tree.bodies) body.subtree_mass = body.moment[3];
  for (std::size_t b = tree.bodies.size() - 1; b > 0; --b) {
    tree.bodies[static_cast<std::size_t>(tree.bodies[b].parent)].subtree_mass +=
        tree.bodies[b].subtree_mass;
  }

  for (std::size_t b = 1; b < tree.bodies.size(); ++b) {
    tree.flat_axes.push_back(flat(tree, tree.bodies[b], axes[b - 1], tree.link_of_body[b]));
  }
  for (const RigidLink& rigid : tree.rigid_links) {
    const int carrier = tree.link_of_body[static_cast<std::size_t>(rigid.body)];
    tree.flat_links.push_back({rigid.link, carrier, {}});
    copy_rows(rigid.body_from_link, tree.flat_links.back().pose);
  }

  tree.support_begin.push_back(0);
  for (const std::vector<int>& indices : support) {
    tree.support.insert(tree.support.end(), indices.begin(), indices.end());
    tree.support_begin.push_back(static_cast<int>(tree.support.size()));
  }
  return tree;
}

Eigen::Isometry3d KinematicTree::body_from_link(int link) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (const RigidLink& rigid : rigid_links) {
    if (rigid.link == link) pose.matrix() = rigid.body_from_link;
  }
  return pose;
}

}  // namespace locograph
