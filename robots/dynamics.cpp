#include <locograph/common/skew.h>
#include <locograph/robots/dynamics.h>
#include <locograph/robots/kinematic_tree.h>

namespace locograph {

RobotDynamics::RobotDynamics(const Robot& robot, const Eigen::Vector3d& gravity)
    : robot_(&robot),
      tree_(&robot.tree()),
      gravity_(gravity),
      inertias_(body_inertias(robot)),
      velocities_(inertias_.size()),
      accelerations_(inertias_.size()),
      motions_(inertias_.size()),
      forces_(inertias_.size()),
      composites_(inertias_.size()) {}

/// What a unit of the active joint's motion gives the axis: its column of the motion subspace,
/// about the base origin.
RobotDynamics::Motion RobotDynamics::axis_motion(const RobotState& state, int axis) const {
  const Eigen::Vector3d along =
      robot_->axes()[static_cast<std::size_t>(axis)].multiplier * state.joint_axis(axis);
  if (!tree_->bodies[static_cast<std::size_t>(axis) + 1].revolute) {
    return {Eigen::Vector3d::Zero(), along};
  }
  return {along, (state.joint_origin(axis) - state.world_from_link(0).translation()).cross(along)};
}

/// Tangent entry of what moves body b.
int RobotDynamics::entry_of_body(std::size_t b) const {
  return robot_->base_tangent_size() + robot_->axes()[b - 1].active;
}

void RobotDynamics::mass_matrix(const RobotState& state, Eigen::Ref<Eigen::MatrixXd> mass) {
  const int base = robot_->base_tangent_size();
  const Eigen::Isometry3d& world_from_base = state.world_from_link(0);
  for (std::size_t b = 0; b < inertias_.size(); ++b) {
    const Eigen::Isometry3d& pose = state.world_from_link(tree_->link_of_body[b]);
    const BodyInertia& body = inertias_[b];
    const Eigen::Vector3d com = pose * body.com - world_from_base.translation();
    Composite& composite = composites_[b];
    composite.mass = body.mass;
    composite.moment = body.mass * com;
    Eigen::Matrix3d rotated;
    rotated.noalias() = pose.linear() * body.inertia;
    composite.inertia.noalias() = rotated * pose.linear().transpose();
    composite.inertia.noalias() -= composite.moment * com.transpose();
    composite.inertia.diagonal().array() += composite.moment.dot(com);
    if (b > 0) motions_[b] = axis_motion(state, static_cast<int>(b) - 1);
  }
  mass.setZero();
  for (std::size_t b = inertias_.size() - 1; b > 0; --b) {
    const int entry = entry_of_body(b);
    const Composite& composite = composites_[b];
    const Motion& motion = motions_[b];
    const Eigen::Vector3d force =
        composite.mass * motion.linear + motion.angular.cross(composite.moment);
    const Eigen::Vector3d moment =
        composite.inertia * motion.angular + composite.moment.cross(motion.linear);
    for (std::size_t above = b; above > 0;
         above = static_cast<std::size_t>(tree_->bodies[above].parent)) {
      const Motion& upper = motions_[above];
      const double value = upper.angular.dot(moment) + upper.linear.dot(force);
      const int other = entry_of_body(above);
      mass(entry, other) += value;
      if (above != b) mass(other, entry) += value;
    }
    if (base > 0) {
      const Eigen::Vector3d linear = world_from_base.linear().transpose() * force;
      const Eigen::Vector3d angular = world_from_base.linear().transpose() * moment;
      mass.block<3, 1>(0, entry) += linear;
      mass.block<3, 1>(3, entry) += angular;
      mass.block<1, 3>(entry, 0) += linear.transpose();
      mass.block<1, 3>(entry, 3) += angular.transpose();
    }
    Composite& parent = composites_[static_cast<std::size_t>(tree_->bodies[b].parent)];
    parent.mass += composite.mass;
    parent.moment += composite.moment;
    parent.inertia += composite.inertia;
  }
  if (base > 0) {
    const Composite& whole = composites_[0];
    const Eigen::Vector3d moment = world_from_base.linear().transpose() * whole.moment;
    const Eigen::Matrix3d cross = skew(moment);
    mass.block<3, 3>(0, 0).diagonal().setConstant(whole.mass);
    mass.block<3, 3>(0, 3) = -cross;
    mass.block<3, 3>(3, 0) = cross;
    const Eigen::Matrix3d inertia =
        world_from_base.linear().transpose() * whole.inertia * world_from_base.linear();
    mass.block<3, 3>(3, 3) = 0.5 * (inertia + inertia.transpose());
  }
}

void RobotDynamics::inverse_dynamics(const RobotState& state,
                                     const Eigen::Ref<const Eigen::VectorXd>& velocity,
                                     const Eigen::Ref<const Eigen::VectorXd>& acceleration,
                                     std::span<const PointWrench> wrenches,
                                     Eigen::Ref<Eigen::VectorXd> torques) {
  recurse(state, velocity.data(), acceleration.data(), wrenches, torques);
}

void RobotDynamics::bias_forces(const RobotState& state,
                                const Eigen::Ref<const Eigen::VectorXd>& velocity,
                                Eigen::Ref<Eigen::VectorXd> torques) {
  recurse(state, velocity.data(), nullptr, {}, torques);
}

/// No acceleration stands for zero.
void RobotDynamics::recurse(const RobotState& state, const double* velocity,
                            const double* acceleration, std::span<const PointWrench> wrenches,
                            Eigen::Ref<Eigen::VectorXd> torques) {
  const int base = robot_->base_tangent_size();
  const Eigen::Isometry3d& world_from_base = state.world_from_link(0);
  const Eigen::Vector3d origin = world_from_base.translation();

  velocities_[0] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  accelerations_[0] = {Eigen::Vector3d::Zero(), -gravity_};
  if (base > 0) {
    const Eigen::Map<const Eigen::Vector3d> linear(velocity), angular(velocity + 3);
    velocities_[0].linear.noalias() = world_from_base.linear() * linear;
    velocities_[0].angular.noalias() = world_from_base.linear() * angular;
    if (acceleration != nullptr) {
      const Eigen::Map<const Eigen::Vector3d> forward(acceleration), turning(acceleration + 3);
      accelerations_[0].linear.noalias() += world_from_base.linear() * forward;
      accelerations_[0].angular.noalias() += world_from_base.linear() * turning;
    }
  }
  for (std::size_t b = 0; b < inertias_.size(); ++b) {
    Motion& v = velocities_[b];
    Motion& a = accelerations_[b];
    if (b > 0) {
      const std::size_t parent = static_cast<std::size_t>(tree_->bodies[b].parent);
      const int entry = entry_of_body(b);
      const double speed = velocity[entry];
      const double change = acceleration == nullptr ? 0.0 : acceleration[entry];
      const Motion s = axis_motion(state, static_cast<int>(b) - 1);
      motions_[b] = s;
      v.angular = velocities_[parent].angular + speed * s.angular;
      v.linear = velocities_[parent].linear + speed * s.linear;
      a.angular =
          accelerations_[parent].angular + change * s.angular + speed * v.angular.cross(s.angular);
      a.linear = accelerations_[parent].linear + change * s.linear +
                 speed * (v.angular.cross(s.linear) + v.linear.cross(s.angular));
    }
    const Eigen::Isometry3d& pose = state.world_from_link(tree_->link_of_body[b]);
    const BodyInertia& body = inertias_[b];
    const Eigen::Vector3d com = pose * body.com - origin;
    const Eigen::Vector3d momentum = body.mass * (v.linear + v.angular.cross(com));
    const Eigen::Matrix3d body_from_world = pose.linear().transpose();
    const Eigen::Vector3d spin = body.inertia * (body_from_world * v.angular);
    const Eigen::Vector3d spin_change = body.inertia * (body_from_world * a.angular);
    const Eigen::Vector3d angular_momentum = pose.linear() * spin + com.cross(momentum);
    const Eigen::Vector3d inertial_force = body.mass * (a.linear + a.angular.cross(com));
    forces_[b].force = inertial_force + v.angular.cross(momentum);
    forces_[b].moment = pose.linear() * spin_change + com.cross(inertial_force) +
                        v.angular.cross(angular_momentum) + v.linear.cross(momentum);
  }
  for (const PointWrench& wrench : wrenches) {
    const std::size_t body =
        static_cast<std::size_t>(tree_->body_of_link[static_cast<std::size_t>(wrench.link)]);
    const Eigen::Vector3d arm = state.world_from_link(wrench.link) * wrench.point - origin;
    forces_[body].force -= wrench.force;
    forces_[body].moment -= arm.cross(wrench.force) + wrench.moment;
  }
  torques.setZero();
  for (std::size_t b = inertias_.size() - 1; b > 0; --b) {
    const Motion& s = motions_[b];
    const Force& f = forces_[b];
    torques[entry_of_body(b)] += s.angular.dot(f.moment) + s.linear.dot(f.force);
    Force& parent = forces_[static_cast<std::size_t>(tree_->bodies[b].parent)];
    parent.force += f.force;
    parent.moment += f.moment;
  }
  if (base > 0) {
    torques.head<3>().noalias() = world_from_base.linear().transpose() * forces_[0].force;
    torques.segment<3>(3).noalias() = world_from_base.linear().transpose() * forces_[0].moment;
  }
}

}  // namespace locograph
