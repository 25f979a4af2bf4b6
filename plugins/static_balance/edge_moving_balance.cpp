#include <locograph/common/skew.h>
#include <locograph/plugins/acceleration_limits/acceleration_rows.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/static_balance/edge_moving_balance.h>
#include <locograph/plugins/static_balance/static_rows.h>
#include <locograph/robots/statics.h>

namespace locograph {

template class TypedEdgePool<EdgeMovingBalance>;

namespace {

/// Inertial forces of the links, of three configurations.
class LinkForces {
 public:
  LinkForces(const ConfigurationState& before, const ConfigurationState& here,
             const ConfigurationState& after)
      : before_(before.kinematics),
        here_(here.kinematics),
        after_(after.kinematics),
        robot_(here.model()),
        base_(here_.world_from_link(0).linear().transpose()),
        origin_(here_.world_from_link(0).translation()),
        difference_(here.time_s - before.time_s, after.time_s - here.time_s) {
    difference_.require_increasing(EdgeMovingBalance::kTag);
  }

  void subtract_from(BaseWrench wrench) const {
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = force;
    for (int link = 0; link < links(); ++link) {
      const double mass = mass_of(link);
      if (!(mass > 0.0)) continue;
      const Eigen::Vector3d own = mass * acceleration(link);
      force += own;
      moment += arm(link).cross(own);
    }
    wrench.head<3>().noalias() -= base_ * force;
    wrench.tail<3>().noalias() -= base_ * moment;
  }

  void subtract_gradients_from(BaseWrenchGradient by_before, BaseWrenchGradient by_here,
                               BaseWrenchGradient by_after) const {
    const double step_1 = difference_.step_1, step_2 = difference_.step_2;
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = force;
    for (int link = 0; link < links(); ++link) {
      const double mass = mass_of(link);
      if (!(mass > 0.0)) continue;
      const Eigen::Vector3d own = mass * acceleration(link), none = Eigen::Vector3d::Zero();
      subtract_link(before_, link, mass * step_1, none, by_before);
      subtract_link(after_, link, mass * step_2, none, by_after);
      subtract_link(here_, link, -mass * (step_1 + step_2), own, by_here);
      // The arms do not change when the base is moved as a whole.
      by_here.block<3, 3>(3, 0) -= skew(base_ * own);
      force += own;
      moment += arm(link).cross(own);
    }
    by_here.block<3, 3>(0, 3) -= skew(base_ * force);
    by_here.block<3, 3>(3, 3) -= skew(base_ * moment);
  }

 private:
  int links() const { return static_cast<int>(robot_.links().size()); }
  double mass_of(int link) const { return robot_.links()[static_cast<std::size_t>(link)].mass; }
  Eigen::Vector3d centre(const RobotState& state, int link) const {
    return state.world_from_link(link) * robot_.links()[static_cast<std::size_t>(link)].com;
  }
  Eigen::Vector3d arm(int link) const { return centre(here_, link) - origin_; }
  Eigen::Vector3d acceleration(int link) const {
    const Eigen::Vector3d middle = centre(here_, link);
    return difference_.step_2 * (centre(after_, link) - middle) -
           difference_.step_1 * (middle - centre(before_, link));
  }

  /// Of a link that moves with one of the configurations: scale times how its centre moves is
  /// force, its arm changes by how it moves while `own` acts.
  void subtract_link(const RobotState& state, int link, double scale, const Eigen::Vector3d& own,
                     BaseWrenchGradient gradient) const {
    const Eigen::Vector3d point = centre(state, link), from_base = arm(link);
    const Eigen::Isometry3d& world_from_base = state.world_from_link(0);
    const auto subtract = [&](int column, const Eigen::Vector3d& moved) {
      const Eigen::Vector3d force = scale * moved;
      gradient.block<3, 1>(0, column).noalias() -= base_ * force;
      gradient.block<3, 1>(3, column).noalias() -=
          base_ * (from_base.cross(force) + moved.cross(own));
    };
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d along = world_from_base.linear().col(axis);
      subtract(axis, along);
      subtract(3 + axis, along.cross(point - world_from_base.translation()));
    }
    for (const int i : robot_.support(link)) {
      const Axis& axis = robot_.axes()[static_cast<std::size_t>(i)];
      subtract(6 + axis.active, axis.multiplier * point_column(state, i, point));
    }
  }

  const RobotState &before_, &here_, &after_;
  const Robot& robot_;
  const Eigen::Matrix3d base_;  // base_from_world, of the middle
  const Eigen::Vector3d origin_;
  const SecondDifference difference_;
};

}  // namespace

void EdgeMovingBalance::error(const ConfigurationState& here, const WrenchesState& wrenches,
                              const ConfigurationState& before, const ConfigurationState& after,
                              Eigen::Ref<Eigen::Matrix<double, 6, 1>> e) const {
  require_same_robot(kTag, before.robot, here.robot);
  require_same_robot(kTag, after.robot, here.robot);
  balance_of_base(kTag, here, wrenches, e);
  LinkForces(before, here, after).subtract_from(e);
  e -= load;
}

double EdgeMovingBalance::row_tolerance(int, const VertexConfiguration& here, const VertexWrenches&,
                                        const VertexConfiguration&,
                                        const VertexConfiguration&) const {
  constexpr double kOfCurve = 2.5;  // the parabola is not the curve, which plans' wrenches go with
  return kOfCurve * balance_tolerance(*here.robot->robot);
}

void EdgeMovingBalance::jacobians(const ConfigurationState& here, const WrenchesState& wrenches,
                                  const ConfigurationState& before, const ConfigurationState& after,
                                  JacobianRef<EdgeMovingBalance, 0> by_here,
                                  JacobianRef<EdgeMovingBalance, 1> by_wrenches,
                                  JacobianRef<EdgeMovingBalance, 2> by_before,
                                  JacobianRef<EdgeMovingBalance, 3> by_after) const {
  balance_of_base_gradients(here, wrenches, by_here, by_wrenches);
  LinkForces(before, here, after).subtract_gradients_from(by_before, by_here, by_after);
}

}  // namespace locograph
