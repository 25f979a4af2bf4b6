#include <locograph/common/skew.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/static_balance/static_rows.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/statics.h>

#include <algorithm>
#include <utility>

namespace locograph {
namespace {

bool revolute(const RobotState& state, int i) {
  return state.robot().tree().bodies[static_cast<std::size_t>(i) + 1].revolute;
}
/// The axis above axis i, -1 when there is none.
int above(const RobotState& state, int i) {
  return state.robot().tree().bodies[static_cast<std::size_t>(i) + 1].parent - 1;
}

const Axis& axis_at(const RobotState& state, int i) {
  return state.robot().axes()[static_cast<std::size_t>(i)];
}

Eigen::Matrix3d base_from_world(const RobotState& state) {
  return state.world_from_link(0).linear().transpose();
}

/// What turning the base does to a wrench fixed in the world, all along the base axes.
void add_turning(const Eigen::Vector3d& arm, const Eigen::Vector3d& force,
                 const Eigen::Vector3d& moment, BaseWrenchGradient gradient) {
  const Eigen::Matrix3d turning = skew(force);
  gradient.block<3, 3>(0, 3) += turning;
  gradient.block<3, 3>(3, 3).noalias() += skew(arm) * turning;
  gradient.block<3, 3>(3, 3) += skew(moment);
}

/// Force and moment about the point, for each radian that the normal of a ball turns about its bar.
std::pair<Eigen::Vector3d, Eigen::Vector3d> turned_about_bar(const AppliedWrench& applied) {
  const Eigen::Vector3d axis = applied.contact->about_bar->axis();
  return {axis.cross(applied.force), axis.cross(applied.moment)};
}

}  // namespace

Eigen::Vector3d point_column(const RobotState& state, int i, const Eigen::Vector3d& point) {
  const Eigen::Vector3d& axis = state.joint_axis(i);
  if (!revolute(state, i)) return axis;
  return axis.cross(point - state.joint_origin(i));
}

AppliedWrench::AppliedWrench(const RobotState& state, const ContactParameter& c,
                             const double* components)
    : contact(&c) {
  const Eigen::Isometry3d& world_from_link = state.world_from_link(c.link);
  point = world_from_link * c.contact.effector.point;
  touching_offset = c.touching_offset;
  if (c.about_bar) {
    const Eigen::Matrix3d round =
        Eigen::Quaterniond::FromTwoVectors(c.axes.col(2), c.about_bar->normal(point))
            .toRotationMatrix();
    axes.noalias() = round * c.axes;
    touching_offset = round * c.touching_offset;
  } else if (c.axes_in_world) {
    axes = c.axes;
  } else {
    axes.noalias() = world_from_link.linear() * c.axes;
  }
  force.setZero();
  moment.setZero();
  for (const int component : c.cone->components()) {
    (component < 3 ? force : moment) += *components * axes.col(component % 3);
    ++components;
  }
  moment += touching_offset.cross(force);
}

void add_gravity_on_base(const RobotState& state, BaseWrench wrench) {
  state.require_mass();
  const Eigen::Isometry3d& world_from_base = state.world_from_link(0);
  const Eigen::Vector4d& moment = state.subtree_moment(0);
  const Eigen::Vector3d arm = moment.head<3>() - moment[3] * world_from_base.translation();
  const Eigen::Vector3d gravity = standard_gravity();
  wrench.head<3>().noalias() += moment[3] * (base_from_world(state) * gravity);
  wrench.tail<3>().noalias() += base_from_world(state) * arm.cross(gravity);
}

void add_gravity_on_base_gradient(const RobotState& state, BaseWrenchGradient gradient) {
  state.require_mass();
  const Eigen::Matrix3d base = base_from_world(state);
  const Eigen::Vector4d& moment = state.subtree_moment(0);
  const Eigen::Vector3d gravity = standard_gravity();
  const Eigen::Vector3d arm =
      base * (moment.head<3>() - moment[3] * state.world_from_link(0).translation());
  const Eigen::Matrix3d turning = skew(base * gravity);
  gradient.block<3, 3>(0, 3) += moment[3] * turning;
  gradient.block<3, 3>(3, 3).noalias() += skew(arm) * turning;
  for (int i = 0; i < static_cast<int>(state.robot().axes().size()); ++i) {
    const Axis& axis = axis_at(state, i);
    gradient.block<3, 1>(3, 6 + axis.active).noalias() +=
        base * (axis.multiplier * state.moment_column(i)).cross(gravity);
  }
}

void add_wrench_on_base(const RobotState& state, const AppliedWrench& applied, BaseWrench wrench) {
  const Eigen::Vector3d arm = applied.point - state.world_from_link(0).translation();
  const Eigen::Matrix3d base = base_from_world(state);
  wrench.head<3>().noalias() += base * applied.force;
  wrench.tail<3>().noalias() += base * (arm.cross(applied.force) + applied.moment);
}

void add_wrench_on_base_gradient(const RobotState& state, const AppliedWrench& applied,
                                 BaseWrenchGradient gradient) {
  const bool turns = !applied.contact->axes_in_world;
  const Eigen::Matrix3d base = base_from_world(state);
  const Eigen::Vector3d arm = applied.point - state.world_from_link(0).translation();
  if (!turns) add_turning(base * arm, base * applied.force, base * applied.moment, gradient);
  for (const int k : state.robot().support(applied.contact->link)) {
    const Axis& axis = axis_at(state, k);
    const int column = 6 + axis.active;
    Eigen::Vector3d moment =
        axis.multiplier * point_column(state, k, applied.point).cross(applied.force);
    if (turns && revolute(state, k)) {
      const Eigen::Vector3d along = axis.multiplier * state.joint_axis(k);
      const Eigen::Vector3d force = along.cross(applied.force);
      moment += arm.cross(force) + along.cross(applied.moment);
      gradient.block<3, 1>(0, column).noalias() += base * force;
    }
    gradient.block<3, 1>(3, column).noalias() += base * moment;
  }
  if (!applied.contact->about_bar) return;
  const auto [force_turned, moment_turned] = turned_about_bar(applied);
  Eigen::Matrix<double, 6, 1> turned;
  turned << base * force_turned, base * (arm.cross(force_turned) + moment_turned);
  const Eigen::Vector3d turn = applied.contact->about_bar->turn_per_metre(applied.point);
  for (int row = 0; row < 6; ++row) {
    state.add_point_gradient(applied.contact->link, applied.point, turn, turned[row],
                             gradient.row(row).data());
  }
}

void add_wrench_on_base_by_components(const RobotState& state, const AppliedWrench& applied,
                                      int first, BaseWrenchGradient gradient) {
  const Eigen::Matrix3d directions = base_from_world(state) * applied.axes;
  const Eigen::Vector3d arm = base_from_world(state) * (applied.point + applied.touching_offset -
                                                        state.world_from_link(0).translation());
  for (const int component : applied.contact->cone->components()) {
    const Eigen::Vector3d direction = directions.col(component % 3);
    if (component < 3) {
      gradient.block<3, 1>(0, first) += direction;
      gradient.block<3, 1>(3, first) += arm.cross(direction);
    } else {
      gradient.block<3, 1>(3, first) += direction;
    }
    ++first;
  }
}

void balance_of_base(std::string_view tag, const ConfigurationState& q,
                     const WrenchesState& wrenches, BaseWrench e) {
  if (!q.model().floating_base()) {
    throw locograph::Error(std::string(tag) + " on a robot with a fixed base", "a floating base");
  }
  require_same_robot(tag, q.robot, wrenches.contacts->front()->robot);
  e.setZero();
  add_gravity_on_base(q.kinematics, e);
  const double* components = wrenches.components.data();
  for (const auto& contact : *wrenches.contacts) {
    add_wrench_on_base(q.kinematics, AppliedWrench(q.kinematics, *contact, components), e);
    components += contact->cone->components().size();
  }
}

void balance_of_base_gradients(const ConfigurationState& q, const WrenchesState& wrenches,
                               BaseWrenchGradient by_q, BaseWrenchGradient by_wrenches) {
  add_gravity_on_base_gradient(q.kinematics, by_q);
  int first = 0;
  for (const auto& contact : *wrenches.contacts) {
    const AppliedWrench applied(q.kinematics, *contact, wrenches.components.data() + first);
    add_wrench_on_base_gradient(q.kinematics, applied, by_q);
    add_wrench_on_base_by_components(q.kinematics, applied, first, by_wrenches);
    first += static_cast<int>(contact->cone->components().size());
  }
}

double balance_tolerance(const Robot& robot) {
  constexpr double kPart = 2e-4;
  return kPart * robot.total_mass() * standard_gravity().norm();
}

double gravity_torque(const RobotState& state, int i) {
  return -standard_gravity().dot(state.moment_column(i));
}

void add_gravity_gradient(const RobotState& state, int i, double scale, double* row) {
  const Robot& robot = state.robot();
  const Eigen::Vector3d gravity = -scale * standard_gravity();
  const Eigen::Vector3d own = state.moment_column(i).cross(gravity);
  const int base = robot.base_tangent_size();
  if (base > 0) {
    Eigen::Map<Eigen::Vector3d>(row + 3).noalias() += base_from_world(state) * own;
  }
  const auto entry = [&](int k) -> double& { return row[base + axis_at(state, k).active]; };
  const auto multiplier = [&](int k) { return axis_at(state, k).multiplier; };
  for (int k = i; k >= 0; k = above(state, k)) {
    if (revolute(state, k)) entry(k) += multiplier(k) * state.joint_axis(k).dot(own);
  }
  if (!revolute(state, i)) return;
  // Axes are numbered depth first: those behind axis i follow it without a gap.
  for (int k = i + 1; k < static_cast<int>(robot.axes().size()) && above(state, k) >= i; ++k) {
    entry(k) += multiplier(k) * state.joint_axis(i).dot(state.moment_column(k).cross(gravity));
  }
}

double wrench_torque(const RobotState& state, const AppliedWrench& applied, int i) {
  const double torque = point_column(state, i, applied.point).dot(applied.force);
  return revolute(state, i) ? torque + state.joint_axis(i).dot(applied.moment) : torque;
}

void add_wrench_gradient(const RobotState& state, const AppliedWrench& applied, int i, double scale,
                         double* row) {
  const Robot& robot = state.robot();
  const bool turns = !applied.contact->axes_in_world;
  const int base = robot.base_tangent_size();
  if (applied.contact->about_bar) {
    const auto [force, moment] = turned_about_bar(applied);
    double torque = point_column(state, i, applied.point).dot(force);
    if (revolute(state, i)) torque += state.joint_axis(i).dot(moment);
    state.add_point_gradient(applied.contact->link, applied.point,
                             applied.contact->about_bar->turn_per_metre(applied.point),
                             scale * torque, row);
  }
  const auto entry = [&](int k) -> double& { return row[base + axis_at(state, k).active]; };
  const auto multiplier = [&](int k) { return axis_at(state, k).multiplier; };
  const Eigen::Vector3d axis = scale * state.joint_axis(i);
  if (!turns) {
    Eigen::Vector3d back = scale * point_column(state, i, applied.point).cross(applied.force);
    if (revolute(state, i)) back += axis.cross(applied.moment);
    if (base > 0) Eigen::Map<Eigen::Vector3d>(row + 3).noalias() += base_from_world(state) * back;
    for (int k = i; k >= 0; k = above(state, k)) {
      if (revolute(state, k)) entry(k) += multiplier(k) * state.joint_axis(k).dot(back);
    }
  }
  const Eigen::Vector3d arm = applied.point - state.joint_origin(i);
  for (const int k : robot.support(applied.contact->link)) {
    if (k <= i) continue;
    const bool turned = turns && revolute(state, k);
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    if (turned) force = state.joint_axis(k).cross(applied.force);
    if (!revolute(state, i)) {
      entry(k) += multiplier(k) * axis.dot(force);
      continue;
    }
    Eigen::Vector3d moment =
        point_column(state, k, applied.point).cross(applied.force) + arm.cross(force);
    if (turned) moment += state.joint_axis(k).cross(applied.moment);
    entry(k) += multiplier(k) * axis.dot(moment);
  }
}

void add_wrench_gradient_by_components(const RobotState& state, const AppliedWrench& applied, int i,
                                       double scale, double* row) {
  const Eigen::Vector3d by_force =
      scale * point_column(state, i, applied.point + applied.touching_offset);
  Eigen::Vector3d by_moment = Eigen::Vector3d::Zero();
  if (revolute(state, i)) by_moment = scale * state.joint_axis(i);
  for (const int component : applied.contact->cone->components()) {
    const Eigen::Vector3d& direction = component < 3 ? by_force : by_moment;
    *row++ += applied.axes.col(component % 3).dot(direction);
  }
}

void static_torques(const RobotState& state, const WrenchesState& wrenches,
                    Eigen::Ref<Eigen::VectorXd> torques) {
  state.require_mass();
  const Robot& robot = state.robot();
  const std::vector<Axis>& axes = robot.axes();
  torques.setZero();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    torques[axes[i].active] += axes[i].multiplier * gravity_torque(state, static_cast<int>(i));
  }
  const double* components = wrenches.components.data();
  for (const auto& contact : *wrenches.contacts) {
    const AppliedWrench applied(state, *contact, components);
    for (const int i : robot.support(contact->link)) {
      const Axis& axis = axes[static_cast<std::size_t>(i)];
      torques[axis.active] -= axis.multiplier * wrench_torque(state, applied, i);
    }
    components += contact->cone->components().size();
  }
}

bool supports(const Robot& robot, int i, int link) {
  const std::span<const int> joints = robot.support(link);
  return std::find(joints.begin(), joints.end(), i) != joints.end();
}

}  // namespace locograph
