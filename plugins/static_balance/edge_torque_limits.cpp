#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/static_balance/edge_torque_limits.h>
#include <locograph/plugins/static_balance/static_rows.h>

#include <cmath>

namespace locograph {

template class TypedEdgePool<EdgeTorqueLimits>;

namespace {

void require_efforts(const Robot& robot) {
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const Joint& joint = robot.active_joint(i);
    if (joint.max_effort > 0.0) continue;
    throw Error("joint " + joint.name + " has an effort limit of " +
                    std::to_string(joint.max_effort) + ", with which it cannot hold anything",
                "a positive effort in the URDF, or none");
  }
}

}  // namespace

EdgeTorqueLimits::EdgeTorqueLimits(const Robot& robot, double fraction_, double weight)
    : fraction(fraction_) {
  require_efforts(robot);
  weights.setConstant(robot.active_joint_count(), weight);
}

void EdgeTorqueLimits::bind(const Parameters& parameters) {
  if (!(fraction > 0.0)) {
    throw locograph::Error(std::string(kTag) + " with a fraction of " + std::to_string(fraction),
                           "a fraction above zero");
  }
  require_fitting_robot(parameters, kTag, dimension(), [&](const RobotParameter& p) {
    if (p.robot->active_joint_count() == dimension()) require_efforts(*p.robot);
    return p.robot->active_joint_count();
  });
}

void EdgeTorqueLimits::error(const ConfigurationState& q, const WrenchesState& wrenches,
                             Eigen::Ref<Eigen::VectorXd> e) const {
  const Robot& robot = q.model();
  require_rows(kTag, e.size(), robot.active_joint_count());
  require_same_robot(kTag, q.robot, wrenches.contacts->front()->robot);
  static_torques(q.kinematics, wrenches, e);
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    e[i] = std::max(0.0, std::abs(e[i]) - fraction * robot.active_joint(i).max_effort);
  }
}

void EdgeTorqueLimits::jacobians(const ConfigurationState& q, const WrenchesState& wrenches,
                                 JacobianRef<EdgeTorqueLimits, 0> by_q,
                                 JacobianRef<EdgeTorqueLimits, 1> by_wrenches) const {
  const RobotState& state = q.kinematics;
  const Robot& robot = q.model();
  /// f(applied wrench, its first component) for the contacts that an axis carries.
  const auto each_wrench = [&](int axis, auto&& f) {
    int first = 0;
    for (const auto& contact : *wrenches.contacts) {
      if (supports(robot, axis, contact->link)) {
        f(AppliedWrench(state, *contact, wrenches.components.data() + first), first);
      }
      first += static_cast<int>(contact->cone->components().size());
    }
  };
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const double limit = fraction * robot.active_joint(i).max_effort;
    if (std::isinf(limit)) continue;
    double torque = 0.0;
    for (const int axis : robot.axes_of(i)) {
      double of_axis = gravity_torque(state, axis);
      each_wrench(axis, [&](const AppliedWrench& applied, int) {
        of_axis -= wrench_torque(state, applied, axis);
      });
      torque += robot.axes()[static_cast<std::size_t>(axis)].multiplier * of_axis;
    }
    if (std::abs(torque) <= limit) continue;
    const double sign = torque > 0.0 ? 1.0 : -1.0;
    double* row = by_q.row(i).data();
    for (const int axis : robot.axes_of(i)) {
      const double scale = sign * robot.axes()[static_cast<std::size_t>(axis)].multiplier;
      add_gravity_gradient(state, axis, scale, row);
      each_wrench(axis, [&](const AppliedWrench& applied, int first) {
        add_wrench_gradient(state, applied, axis, -scale, row);
        add_wrench_gradient_by_components(state, applied, axis, -scale,
                                          by_wrenches.row(i).data() + first);
      });
    }
  }
}

double EdgeTorqueLimits::row_tolerance(int row, const VertexConfiguration& q,
                                       const VertexWrenches&) const {
  constexpr double kPart = 0.5, kRounding = 1e-7;
  const double effort = q.robot->robot->active_joint(row).max_effort;
  return std::isfinite(effort) ? effort * std::max(kPart * (1.0 - fraction), kRounding) : kRounding;
}

RowLabel EdgeTorqueLimits::row_label(int row, const VertexConfiguration& q,
                                     const VertexWrenches&) const {
  const Joint& joint = q.robot->robot->active_joint(row);
  return {joint.name + " torque", joint.type == JointType::kPrismatic ? "N" : "N m"};
}

}  // namespace locograph
