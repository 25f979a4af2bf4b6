#include <locograph/common/error.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/robot_state.h>

#include <cmath>

namespace locograph {

RobotState::RobotState(const Robot& robot)
    : robot_(&robot),
      tree_(&robot.tree()),
      world_from_link_(robot.links().size(), Eigen::Isometry3d::Identity()),
      joint_origin_(robot.tree().bodies.size() - 1),
      joint_axis_(joint_origin_.size()),
      subtree_moment_(robot.tree().bodies.size()),
      coefficients_(2 * joint_origin_.size()) {
  update(robot.neutral_configuration().data());
}

void RobotState::update(const double* q) {
  const KinematicTree& tree = *tree_;
  const std::size_t axis_count = joint_origin_.size();
  if (robot_->floating_base()) {
    world_from_link_[0].linear() = Eigen::Quaterniond(q[6], q[3], q[4], q[5]).toRotationMatrix();
    world_from_link_[0].translation() << q[0], q[1], q[2];
    q += 7;
  }
  const auto world_from_body = [&](int body) -> Eigen::Matrix4d& {
    const int link = tree.link_of_body[static_cast<std::size_t>(body)];
    return world_from_link_[static_cast<std::size_t>(link)].matrix();
  };
  subtree_moment_[0].noalias() = world_from_body(0) * tree.bodies[0].moment;

  for (std::size_t i = 0; i < axis_count; ++i) {
    const bool revolute = tree.bodies[i + 1].revolute;
    const Axis& axis = robot_->axes()[i];
    const double position = axis.multiplier * q[axis.active] + axis.offset;
    coefficients_[2 * i] = revolute ? std::sin(position) : position;
    coefficients_[2 * i + 1] = revolute ? std::cos(position) : 0.0;
  }
  for (std::size_t i = 0; i < axis_count; ++i) {
    const KinematicTree::Body& body = tree.bodies[i + 1];
    Eigen::Matrix4d local;
    local.noalias() = body.A + coefficients_[2 * i] * body.B + coefficients_[2 * i + 1] * body.C;
    Eigen::Matrix4d& pose = world_from_body(static_cast<int>(i) + 1);
    pose.noalias() = world_from_body(body.parent) * local;
    Eigen::Vector4d axis;
    axis.noalias() = pose * body.axis;
    joint_axis_[i] = axis.head<3>();
    joint_origin_[i] = pose.col(3).head<3>();
    subtree_moment_[i + 1].noalias() = pose * body.moment;
  }
  for (const KinematicTree::RigidLink& rigid : tree.rigid_links) {
    world_from_link_[static_cast<std::size_t>(rigid.link)].matrix().noalias() =
        world_from_body(rigid.body) * rigid.body_from_link;
  }
  for (std::size_t b = axis_count; b > 0; --b) {
    subtree_moment_[static_cast<std::size_t>(tree.bodies[b].parent)] += subtree_moment_[b];
  }
}

void RobotState::frame_jacobian(
    int link, const Eigen::Isometry3d& link_from_frame,
    Eigen::Ref<Eigen::Matrix<double, 6, Eigen::Dynamic>> jacobian) const {
  jacobian.setZero();
  const Eigen::Vector3d point = world_from_link(link) * link_from_frame.translation();
  const int base = robot_->base_tangent_size();
  if (base > 0) {
    const Eigen::Matrix3d rotation = world_from_base().linear();
    const Eigen::Vector3d arm = point - world_from_base().translation();
    jacobian.topLeftCorner<3, 3>() = rotation;
    jacobian.block<3, 3>(3, 3) = rotation;
    for (int k = 0; k < 3; ++k) jacobian.block<3, 1>(0, 3 + k) = rotation.col(k).cross(arm);
  }
  for (const int i : robot_->support(link)) {
    const Axis& axis = robot_->axes()[static_cast<std::size_t>(i)];
    const int column = base + axis.active;
    const Eigen::Vector3d direction = axis.multiplier * joint_axis(i);
    if (tree_->bodies[static_cast<std::size_t>(i) + 1].revolute) {
      jacobian.block<3, 1>(0, column) += direction.cross(point - joint_origin(i));
      jacobian.block<3, 1>(3, column) += direction;
    } else {
      jacobian.block<3, 1>(0, column) += direction;
    }
  }
}

void RobotState::point_jacobian(
    int link, const Eigen::Vector3d& point_world,
    Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> jacobian) const {
  const int base = robot_->base_tangent_size();
  if (base > 0) {
    const Eigen::Matrix3d rotation = world_from_base().linear();
    const Eigen::Vector3d arm = point_world - world_from_base().translation();
    jacobian.leftCols<3>() = rotation;
    for (int k = 0; k < 3; ++k) jacobian.col(3 + k) = rotation.col(k).cross(arm);
  }
  const std::span<const int> support = robot_->support(link);
  for (const int i : support) {
    jacobian.col(base + robot_->axes()[static_cast<std::size_t>(i)].active).setZero();
  }
  for (const int i : support) {
    const Axis& axis = robot_->axes()[static_cast<std::size_t>(i)];
    const Eigen::Vector3d direction = axis.multiplier * joint_axis(i);
    if (tree_->bodies[static_cast<std::size_t>(i) + 1].revolute) {
      jacobian.col(base + axis.active) += direction.cross(point_world - joint_origin(i));
    } else {
      jacobian.col(base + axis.active) += direction;
    }
  }
}

// f . (v + omega x r) + m . omega = v . f + omega . (r x f + m), with v and omega in base axes.
void RobotState::add_base_gradient(const Eigen::Vector3d& point_world,
                                   const Eigen::Vector3d& force_world,
                                   const Eigen::Vector3d& moment_world, double* row,
                                   int stride) const {
  const Eigen::Matrix3d rotation = world_from_base().linear();
  const Eigen::Vector3d arm = point_world - world_from_base().translation();
  const Eigen::Vector3d linear = rotation.transpose() * force_world;
  const Eigen::Vector3d angular = rotation.transpose() * (arm.cross(force_world) + moment_world);
  for (int k = 0; k < 3; ++k) {
    row[k * stride] += linear[k];
    row[(3 + k) * stride] += angular[k];
  }
}

void RobotState::add_point_gradient(int link, const Eigen::Vector3d& point_world,
                                    const Eigen::Vector3d& direction_world, double scale,
                                    double* row, int stride) const {
  add_wrench_gradient(link, point_world, scale * direction_world, Eigen::Vector3d::Zero(), row,
                      stride);
}

// f . (axis x (p - o)) + m . axis = axis . ((p - o) x f + m) for a joint.
void RobotState::add_wrench_gradient(int link, const Eigen::Vector3d& point_world,
                                     const Eigen::Vector3d& force_world,
                                     const Eigen::Vector3d& moment_world, double* row,
                                     int stride) const {
  if (robot_->floating_base()) {
    add_base_gradient(point_world, force_world, moment_world, row, stride);
    row += 6 * stride;
  }
  const int* support = tree_->support.data();
  const int end = tree_->support_begin[static_cast<std::size_t>(link) + 1];
  for (int s = tree_->support_begin[static_cast<std::size_t>(link)]; s < end; ++s) {
    const int i = support[s];
    const Eigen::Vector3d& along = joint_axis(i);
    const double slope =
        tree_->bodies[static_cast<std::size_t>(i) + 1].revolute
            ? along.dot((point_world - joint_origin(i)).cross(force_world) + moment_world)
            : along.dot(force_world);
    const Axis& axis = robot_->axes()[static_cast<std::size_t>(i)];
    row[axis.active * stride] += axis.multiplier * slope;
  }
}

// omega . d, with d in base axes for the base.
void RobotState::add_rotation_gradient(int link, const Eigen::Vector3d& direction_world,
                                       double scale, double* row, int stride) const {
  const Eigen::Vector3d direction = scale * direction_world;
  if (robot_->floating_base()) {
    const Eigen::Vector3d angular = world_from_base().linear().transpose() * direction;
    for (int k = 0; k < 3; ++k) row[(3 + k) * stride] += angular[k];
    row += 6 * stride;
  }
  for (const int i : robot_->support(link)) {
    if (tree_->bodies[static_cast<std::size_t>(i) + 1].revolute) {
      const Axis& axis = robot_->axes()[static_cast<std::size_t>(i)];
      row[axis.active * stride] += axis.multiplier * joint_axis(i).dot(direction);
    }
  }
}

// d . (omega x a) = omega . (a x d); translations do not turn the axis.
void RobotState::add_axis_gradient(int link, const Eigen::Vector3d& axis_world,
                                   const Eigen::Vector3d& direction_world, double scale,
                                   double* row, int stride) const {
  add_rotation_gradient(link, axis_world.cross(direction_world), scale, row, stride);
}

void RobotState::require_mass() const {
  if (!(tree_->bodies[0].subtree_mass > 0.0)) {
    throw Error("robot '" + robot_->name() + "' has no centre of mass",
                "an <inertial> with a positive mass in at least one link of the URDF");
  }
}

Eigen::Vector3d RobotState::center_of_mass() const {
  require_mass();
  return subtree_moment_[0].head<3>() / tree_->bodies[0].subtree_mass;
}

// Moving axis i moves the subtree behind it: sum_k m_k axis x (c_k - o) = axis x (S - M_i o).
Eigen::Vector3d RobotState::moment_column(int i) const {
  const Eigen::Vector4d& moment = subtree_moment(i + 1);
  const Eigen::Vector3d& axis = joint_axis(i);
  if (!tree_->bodies[static_cast<std::size_t>(i) + 1].revolute) return moment[3] * axis;
  return axis.cross(moment.head<3>() - moment[3] * joint_origin(i));
}

void RobotState::center_of_mass_jacobian(
    Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> jacobian) const {
  const Eigen::Vector3d com = center_of_mass();
  const double inverse_mass = 1.0 / tree_->bodies[0].subtree_mass;
  const int base = robot_->base_tangent_size();
  if (base > 0) {
    const Eigen::Matrix3d rotation = world_from_base().linear();
    const Eigen::Vector3d arm = com - world_from_base().translation();
    jacobian.leftCols<3>() = rotation;
    for (int k = 0; k < 3; ++k) jacobian.col(3 + k) = rotation.col(k).cross(arm);
  }
  jacobian.rightCols(robot_->active_joint_count()).setZero();
  for (int i = 0; i < static_cast<int>(robot_->axes().size()); ++i) {
    const Axis& axis = robot_->axes()[static_cast<std::size_t>(i)];
    jacobian.col(base + axis.active) += axis.multiplier * inverse_mass * moment_column(i);
  }
}

void RobotState::add_center_of_mass_gradient(const Eigen::Vector3d& direction_world, double scale,
                                             double* row, int stride) const {
  const Eigen::Vector3d com = center_of_mass();
  const Eigen::Vector3d direction = scale * direction_world;
  if (robot_->floating_base()) {
    add_base_gradient(com, direction, Eigen::Vector3d::Zero(), row, stride);
    row += 6 * stride;
  }
  const Eigen::Vector3d share = direction / tree_->bodies[0].subtree_mass;
  for (int i = 0; i < static_cast<int>(robot_->axes().size()); ++i) {
    const Axis& axis = robot_->axes()[static_cast<std::size_t>(i)];
    row[axis.active * stride] += axis.multiplier * moment_column(i).dot(share);
  }
}

}  // namespace locograph
