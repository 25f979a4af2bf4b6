#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/static_balance/edge_wrench_norm.h>

namespace locograph {

template class TypedEdgePool<EdgeWrenchNorm>;

void EdgeWrenchNorm::error(const WrenchesState& wrenches, Eigen::Ref<Eigen::VectorXd> e) const {
  require_rows(kTag, e.size(), wrenches.components.size());
  e = wrenches.components;
}

void EdgeWrenchNorm::jacobians(const WrenchesState&, JacobianRef<EdgeWrenchNorm, 0> j) const {
  j.diagonal().setOnes();
}

}  // namespace locograph
