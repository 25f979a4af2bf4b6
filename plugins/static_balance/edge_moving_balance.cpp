#include <locograph/common/skew.h>
#include <locograph/plugins/acceleration_limits/acceleration_rows.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/static_balance/edge_moving_balance.h>
#include <locograph/plugins/static_balance/static_rows.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/statics.h>

#include <algorithm>
#include <vector>

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
    std::vector<Subtree>& subtrees = scratch();
    subtract_columns(before_, step_1, false, subtrees, by_before);
    subtract_columns(after_, step_2, false, subtrees, by_after);
    subtract_columns(here_, -(step_1 + step_2), true, subtrees, by_here);
    const Subtree& all = subtrees.front();
    // The arms do not change when the base is moved as a whole.
    by_here.block<3, 3>(3, 0) -= skew(base_ * all.force);
    by_here.block<3, 3>(0, 3) -= skew(base_ * all.force);
    by_here.block<3, 3>(3, 3) -= skew(base_ * all.moment);
  }

 private:
  /// Sums over the links that an axis moves, or over all: of masses m, centres c in one of the
  /// configurations, arms r and inertial forces f; places from the base of the middle one.
  struct Subtree {
    double mass = 0.0;
    Eigen::Vector3d centres = Eigen::Vector3d::Zero();            ///< m c
    Eigen::Vector3d arms = Eigen::Vector3d::Zero();               ///< m r
    Eigen::Matrix3d arms_by_centres = Eigen::Matrix3d::Zero();    ///< m r cᵀ
    Eigen::Vector3d force = Eigen::Vector3d::Zero();              ///< f
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();             ///< r × f
    Eigen::Matrix3d centres_by_forces = Eigen::Matrix3d::Zero();  ///< c fᵀ

    Subtree& operator+=(const Subtree& other) {
      mass += other.mass;
      centres += other.centres;
      arms += other.arms;
      arms_by_centres += other.arms_by_centres;
      force += other.force;
      moment += other.moment;
      centres_by_forces += other.centres_by_forces;
      return *this;
    }
  };

  /// By body, its memory kept.
  std::vector<Subtree>& scratch() const {
    thread_local std::vector<Subtree> subtrees;
    subtrees.resize(robot_.tree().bodies.size());
    return subtrees;
  }

  void sum_up(const RobotState& state, bool forces, std::vector<Subtree>& subtrees) const {
    const KinematicTree& tree = robot_.tree();
    std::ranges::fill(subtrees, Subtree());
    for (int link = 0; link < links(); ++link) {
      const double mass = mass_of(link);
      if (!(mass > 0.0)) continue;
      Subtree& of =
          subtrees[static_cast<std::size_t>(tree.body_of_link[static_cast<std::size_t>(link)])];
      const Eigen::Vector3d from_base = arm(link), at = centre(state, link) - origin_;
      of.mass += mass;
      of.centres += mass * at;
      of.arms += mass * from_base;
      of.arms_by_centres += mass * from_base * at.transpose();
      if (!forces) continue;
      const Eigen::Vector3d own = mass * acceleration(link);
      of.force += own;
      of.moment += from_base.cross(own);
      of.centres_by_forces += at * own.transpose();
    }
    for (std::size_t body = subtrees.size() - 1; body > 0; --body) {
      subtrees[static_cast<std::size_t>(tree.bodies[body].parent)] += subtrees[body];
    }
  }

  /// Of the links that move with one of the configurations: scale times how the centres move are
  /// forces, and arms change by how they move while the inertial forces act (of the middle one).
  void subtract_columns(const RobotState& state, double scale, bool forces,
                        std::vector<Subtree>& subtrees, BaseWrenchGradient gradient) const {
    sum_up(state, forces, subtrees);
    const auto subtract = [&](int column, const Eigen::Vector3d& force,
                              const Eigen::Vector3d& moment) {
      gradient.block<3, 1>(0, column).noalias() -= base_ * force;
      gradient.block<3, 1>(3, column).noalias() -= base_ * moment;
    };
    const auto subtract_shift = [&](int column, const Subtree& of, const Eigen::Vector3d& along) {
      subtract(column, scale * of.mass * along,
               scale * of.arms.cross(along) + along.cross(of.force));
    };
    // With d = c − o: r × (a × d) = a (r · d) − d (r · a), and (a × d) × f = d (a · f) − a (d · f).
    const auto subtract_turn = [&](int column, const Subtree& of, const Eigen::Vector3d& about,
                                   const Eigen::Vector3d& through) {
      const Eigen::Vector3d o = through - origin_;
      const Eigen::Vector3d by_arms =
          about * (of.arms_by_centres.trace() - of.arms.dot(o)) -
          (of.arms_by_centres.transpose() * about - o * of.arms.dot(about));
      const Eigen::Vector3d by_forces = of.centres_by_forces * about - o * of.force.dot(about) -
                                        about * (of.centres_by_forces.trace() - o.dot(of.force));
      subtract(column, scale * about.cross(of.centres - of.mass * o), scale * by_arms + by_forces);
    };
    const Eigen::Isometry3d& world_from_base = state.world_from_link(0);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d along = world_from_base.linear().col(k);
      subtract_shift(k, subtrees.front(), along);
      subtract_turn(3 + k, subtrees.front(), along, world_from_base.translation());
    }
    for (std::size_t i = 0; i < robot_.axes().size(); ++i) {
      const Axis& axis = robot_.axes()[i];
      const Eigen::Vector3d along = axis.multiplier * state.joint_axis(static_cast<int>(i));
      if (robot_.tree().bodies[i + 1].revolute) {
        subtract_turn(6 + axis.active, subtrees[i + 1], along,
                      state.joint_origin(static_cast<int>(i)));
      } else {
        subtract_shift(6 + axis.active, subtrees[i + 1], along);
      }
    }
  }

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
