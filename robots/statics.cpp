#include <locograph/common/skew.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/statics.h>

namespace locograph {
namespace {

const KinematicTree::Body& body_of_axis(const RobotState& state, int axis) {
  return state.robot().tree().bodies[static_cast<std::size_t>(axis) + 1];
}

const Axis& axis_of(const RobotState& state, int axis) {
  return state.robot().axes()[static_cast<std::size_t>(axis)];
}

}  // namespace

void gravity_torques(const RobotState& state, const Eigen::Vector3d& gravity,
                     Eigen::Ref<Eigen::VectorXd> torques) {
  state.require_mass();
  const int base = state.robot().base_tangent_size();
  if (base > 0) {
    const Eigen::Isometry3d& world_from_base = state.world_from_link(0);
    const Eigen::Vector4d& moment = state.subtree_moment(0);
    const Eigen::Vector3d arm = moment.head<3>() - moment[3] * world_from_base.translation();
    torques.head<3>().noalias() = -moment[3] * (world_from_base.linear().transpose() * gravity);
    torques.segment<3>(3).noalias() = -(world_from_base.linear().transpose() * arm.cross(gravity));
  }
  torques.tail(state.robot().active_joint_count()).setZero();
  for (int i = 0; i < static_cast<int>(state.robot().axes().size()); ++i) {
    const Axis& axis = axis_of(state, i);
    torques[base + axis.active] -= axis.multiplier * gravity.dot(state.moment_column(i));
  }
}

void gravity_torque_derivative(const RobotState& state, const Eigen::Vector3d& gravity,
                               Eigen::Ref<Eigen::MatrixXd> derivative) {
  state.require_mass();
  const int base = state.robot().base_tangent_size();
  const Eigen::Isometry3d& world_from_base = state.world_from_link(0);
  derivative.setZero();
  if (base > 0) {
    const Eigen::Vector4d& moment = state.subtree_moment(0);
    const Eigen::Vector3d arm = world_from_base.linear().transpose() *
                                (moment.head<3>() - moment[3] * world_from_base.translation());
    const Eigen::Matrix3d turning = skew(world_from_base.linear().transpose() * gravity);
    derivative.block<3, 3>(0, 3) = -moment[3] * turning;
    derivative.block<3, 3>(3, 3).noalias() = -skew(arm) * turning;
  }
  for (int i = 0; i < static_cast<int>(state.robot().axes().size()); ++i) {
    const Axis& axis = axis_of(state, i);
    const Eigen::Vector3d u = axis.multiplier * state.moment_column(i).cross(gravity);
    const int entry = base + axis.active;
    for (int j = i; j >= 0; j = body_of_axis(state, j).parent - 1) {
      if (!body_of_axis(state, j).revolute) continue;
      const Axis& upper = axis_of(state, j);
      const double value = -upper.multiplier * state.joint_axis(j).dot(u);
      derivative(entry, base + upper.active) += value;
      if (j != i) derivative(base + upper.active, entry) += value;
    }
    if (base > 0) {
      const Eigen::Vector3d column = -(world_from_base.linear().transpose() * u);
      derivative.block<3, 1>(3, entry) += column;
      derivative.block<1, 3>(entry, 3) += column.transpose();
    }
  }
}

void add_wrench_torques(const RobotState& state, const PointWrench& wrench, double scale,
                        Eigen::Ref<Eigen::VectorXd> torques) {
  const Eigen::Vector3d point = state.world_from_link(wrench.link) * wrench.point;
  state.add_point_gradient(wrench.link, point, wrench.force, scale, torques.data());
  const Eigen::Vector3d moment = scale * wrench.moment;
  const int base = state.robot().base_tangent_size();
  if (base > 0) {
    torques.segment<3>(3).noalias() += state.world_from_link(0).linear().transpose() * moment;
  }
  for (const int i : state.robot().support(wrench.link)) {
    if (!body_of_axis(state, i).revolute) continue;
    const Axis& axis = axis_of(state, i);
    torques[base + axis.active] += axis.multiplier * state.joint_axis(i).dot(moment);
  }
}

void add_wrench_torque_derivative(const RobotState& state, const PointWrench& wrench, double scale,
                                  Eigen::Ref<Eigen::MatrixXd> derivative) {
  const int base = state.robot().base_tangent_size();
  const Eigen::Isometry3d& world_from_base = state.world_from_link(0);
  const Eigen::Vector3d point = state.world_from_link(wrench.link) * wrench.point;
  const Eigen::Vector3d force = scale * wrench.force;
  const Eigen::Vector3d moment = scale * wrench.moment;
  if (base > 0) {
    const Eigen::Vector3d arm =
        world_from_base.linear().transpose() * (point - world_from_base.translation());
    const Eigen::Matrix3d turning = skew(world_from_base.linear().transpose() * force);
    derivative.block<3, 3>(0, 3) += turning;
    derivative.block<3, 3>(3, 3).noalias() += skew(arm) * turning;
    derivative.block<3, 3>(3, 3) += skew(world_from_base.linear().transpose() * moment);
  }
  for (const int i : state.robot().support(wrench.link)) {
    const bool revolute = body_of_axis(state, i).revolute;
    const Axis& axis = axis_of(state, i);
    const int entry = base + axis.active;
    const Eigen::Vector3d along = axis.multiplier * state.joint_axis(i);
    Eigen::Vector3d upper, lower;  // u, and u + a x m
    if (revolute) {
      upper = along.cross(point - state.joint_origin(i)).cross(force);
      lower = upper + along.cross(moment);
    } else {
      lower = upper = along.cross(force);
    }
    if (revolute) derivative(entry, entry) += along.dot(upper);
    for (int j = body_of_axis(state, i).parent - 1; j >= 0; j = body_of_axis(state, j).parent - 1) {
      if (!body_of_axis(state, j).revolute) continue;
      const Axis& above = axis_of(state, j);
      const Eigen::Vector3d turning = above.multiplier * state.joint_axis(j);
      derivative(entry, base + above.active) += turning.dot(lower);
      derivative(base + above.active, entry) += turning.dot(upper);
    }
    if (base > 0) {
      derivative.block<3, 1>(3, entry).noalias() += world_from_base.linear().transpose() * upper;
      derivative.block<1, 3>(entry, 3).noalias() += lower.transpose() * world_from_base.linear();
    }
  }
}

void static_torques(const RobotState& state, const Eigen::Vector3d& gravity,
                    std::span<const PointWrench> wrenches, Eigen::Ref<Eigen::VectorXd> torques) {
  gravity_torques(state, gravity, torques);
  for (const PointWrench& wrench : wrenches) add_wrench_torques(state, wrench, -1.0, torques);
}

void static_torque_derivative(const RobotState& state, const Eigen::Vector3d& gravity,
                              std::span<const PointWrench> wrenches,
                              Eigen::Ref<Eigen::MatrixXd> derivative) {
  gravity_torque_derivative(state, gravity, derivative);
  for (const PointWrench& wrench : wrenches) {
    add_wrench_torque_derivative(state, wrench, -1.0, derivative);
  }
}

}  // namespace locograph
