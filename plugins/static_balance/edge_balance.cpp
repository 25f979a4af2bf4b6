#include <locograph/plugins/static_balance/edge_balance.h>
#include <locograph/plugins/static_balance/static_rows.h>

namespace locograph {

template class TypedEdgePool<EdgeBalance>;

void EdgeBalance::error(const ConfigurationState& q, const WrenchesState& wrenches,
                        Eigen::Ref<Eigen::Matrix<double, 6, 1>> e) const {
  balance_of_base(kTag, q, wrenches, e);
}

double EdgeBalance::row_tolerance(int, const VertexConfiguration& q, const VertexWrenches&) const {
  return balance_tolerance(*q.robot->robot);
}

void EdgeBalance::jacobians(const ConfigurationState& q, const WrenchesState& wrenches,
                            JacobianRef<EdgeBalance, 0> by_q,
                            JacobianRef<EdgeBalance, 1> by_wrenches) const {
  balance_of_base_gradients(q, wrenches, by_q, by_wrenches);
}

}  // namespace locograph
