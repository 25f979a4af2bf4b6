#include <locograph/check/limits.h>
#include <locograph/check/motion_curve.h>
#include <locograph/planners/plan/carried_wrenches.h>
#include <locograph/plugins/configuration/vertex_configuration.h>
#include <locograph/plugins/static_balance/static_rows.h>
#include <locograph/robots/dynamics.h>
#include <locograph/robots/statics.h>

#include <Eigen/QR>
#include <algorithm>
#include <vector>

namespace locograph {
namespace {

using BaseLoad = Eigen::Matrix<double, 6, 1>;

constexpr double kArm_m = 0.03;
constexpr double kLeftOver = 0.9 * limits::kWrenchLeftOver;

class CarriedWrenches {
 public:
  /// around: the configurations that may be asked about, and two more on either side.
  CarriedWrenches(const Plan& plan, Graph& graph, const PlanRange& around)
      : plan_(plan),
        graph_(graph),
        first_(around.first),
        motion_(motion_of(graph, plan, around.first, around.last)),
        curve_(*plan.robot->robot, motion_),
        dynamics_(*plan.robot->robot),
        state_(plan.robot),
        weight_N_(plan.robot->robot->total_mass() * standard_gravity().norm()) {}

  void balance(int i) {
    state_.update(motion_.configurations[static_cast<std::size_t>(i - first_)].data());
    for (const int slot : plan_.index.wrenches[static_cast<std::size_t>(i)]) {
      VertexWrenches& vertex = graph_.vertex(VertexId<VertexWrenches>{slot});
      WrenchesState wrenches = vertex.make_derived();
      vertex.derive(vertex.state.data(), wrenches);
      const BaseLoad off = left_over(i, wrenches);
      const double share = off.norm() / weight_N_;
      if (share > kLeftOver) vertex.state += change(wrenches, (1.0 - kLeftOver / share) * off);
    }
  }

 private:
  /// What the curve asks of the base beyond gravity, less what the wrenches do beyond it.
  BaseLoad left_over(int i, const WrenchesState& wrenches) {
    BaseLoad borne;
    balance_of_base("wrenches", state_, wrenches, borne);
    const bool first = i == 0, last = i + 1 == static_cast<int>(plan_.slots.size());
    const int vertex = i - first_;
    const BaseLoad before = first ? rest() : asked(vertex - 1, 1.0);
    const BaseLoad after = last ? rest() : asked(vertex, 0.0);
    const BaseLoad jump = after - before;
    const double length = jump.squaredNorm();
    const double share =
        length > 0.0 ? std::clamp((borne - before).dot(jump) / length, 0.0, 1.0) : 0.0;
    return before + share * jump - borne;
  }

  static BaseLoad rest() { return BaseLoad::Zero(); }

  BaseLoad asked(int step, double fraction) {
    curve_.step(step).at(fraction, point_);
    Eigen::VectorXd torques(point_.velocity.size());
    dynamics_.inverse_dynamics(state_.kinematics, point_.velocity, point_.acceleration, {},
                               torques);
    BaseLoad load = torques.head<6>();
    add_gravity_on_base(state_.kinematics, load);
    return load;
  }

  Eigen::VectorXd change(const WrenchesState& wrenches, const BaseLoad& left_over) const {
    const auto size = wrenches.components.size();
    Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> by_wrenches =
        Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>::Zero(6, size);
    Eigen::VectorXd bears(size);  // s
    int first = 0;
    for (const auto& contact : *wrenches.contacts) {
      const double* components = wrenches.components.data() + first;
      add_wrench_on_base_by_components(state_.kinematics,
                                       AppliedWrench(state_.kinematics, *contact, components),
                                       first, by_wrenches);
      const auto& kinds = contact->cone->components();
      double force = 0.0;
      for (std::size_t c = 0; c < kinds.size(); ++c) {
        if (kinds[c] < 3) force = std::hypot(force, components[c]);
      }
      for (const int kind : kinds) bears[first++] = kind < 3 ? force : kArm_m * force;
    }
    // N and N m alike; what contacts can hardly do, as two balls about the line between them, is
    // not asked of them.
    constexpr double kHardly = 1e-3;
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> effects;
    effects.setThreshold(kHardly);
    effects.compute(by_wrenches * bears.asDiagonal());
    return bears.cwiseProduct(effects.solve(left_over));
  }

  const Plan& plan_;
  Graph& graph_;
  int first_;
  const Motion motion_;  // from configuration first_ on
  const MotionCurve curve_;
  RobotDynamics dynamics_;
  ConfigurationState state_;
  CurvePoint point_;
  double weight_N_;
};

/// Calls f(carried, i) for each configuration of a range.
template <class F>
void for_each_in(const PlanRange& range, const Plan& plan, Graph& graph, F&& f) {
  if (plan.stances_only || !plan.states_wrenches) return;
  constexpr int kBeside = 2;  // slopes by rule have vertices on both sides
  const int end = static_cast<int>(plan.slots.size()) - 1;
  const PlanRange around = {std::max(range.first - kBeside, 0),
                            std::min(range.last + kBeside, end)};
  CarriedWrenches carried(plan, graph, around);
  for (int i = std::max(range.first, 0); i <= std::min(range.last, end); ++i) f(carried, i);
}

}  // namespace

void carry_wrenches(const Motion& before, const Plan& plan, Graph& graph) {
  carry_wrenches(before, plan, graph, {0, static_cast<int>(plan.slots.size()) - 1});
}

void carry_wrenches(const Motion& before, const Plan& plan, Graph& graph, const PlanRange& range) {
  for_each_in(range, plan, graph, [&](CarriedWrenches& carried, int i) {
    if (moved_around(before, plan, graph, i)) carried.balance(i);
  });
}

void balance_wrenches(const Plan& plan, Graph& graph, const PlanRange& range) {
  for_each_in(range, plan, graph, [](CarriedWrenches& carried, int i) { carried.balance(i); });
}

}  // namespace locograph
