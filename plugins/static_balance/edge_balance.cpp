#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/static_balance/edge_balance.h>
#include <locograph/plugins/static_balance/static_rows.h>
#include <locograph/robots/statics.h>

namespace locograph {

template class TypedEdgePool<EdgeBalance>;

void EdgeBalance::error(const ConfigurationState& q, const WrenchesState& wrenches,
                        Eigen::Ref<Eigen::Matrix<double, 6, 1>> e) const {
  if (!q.model().floating_base()) {
    throw locograph::Error(std::string(kTag) + " on a robot with a fixed base", "a floating base");
  }
  require_same_robot(kTag, q.robot, wrenches.contacts->front()->robot);
  e.setZero();
  add_gravity_on_base(q.kinematics, e);
  const double* components = wrenches.components.data();
  for (const auto& contact : *wrenches.contacts) {
    add_wrench_on_base(q.kinematics, AppliedWrench(q.kinematics, *contact, components), e);
    components += contact->cone->components().size();
  }
}

double EdgeBalance::row_tolerance(int, const VertexConfiguration& q, const VertexWrenches&) const {
  constexpr double kPart = 2e-4;
  return kPart * q.robot->robot->total_mass() * standard_gravity().norm();
}

void EdgeBalance::jacobians(const ConfigurationState& q, const WrenchesState& wrenches,
                            JacobianRef<EdgeBalance, 0> by_q,
                            JacobianRef<EdgeBalance, 1> by_wrenches) const {
  add_gravity_on_base_gradient(q.kinematics, by_q);
  int first = 0;
  for (const auto& contact : *wrenches.contacts) {
    const AppliedWrench applied(q.kinematics, *contact, wrenches.components.data() + first);
    add_wrench_on_base_gradient(q.kinematics, applied, by_q);
    add_wrench_on_base_by_components(q.kinematics, applied, first, by_wrenches);
    first += static_cast<int>(contact->cone->components().size());
  }
}

}  // namespace locograph
