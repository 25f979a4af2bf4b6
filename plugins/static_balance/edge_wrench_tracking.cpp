#include <locograph/core/graph.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/static_balance/edge_wrench_tracking.h>

namespace locograph {

template class TypedEdgePool<EdgeWrenchTracking>;

void EdgeWrenchTracking::check(const Graph& graph) const {
  require_rows(kTag, dimension(), graph.dimension(vertices[0]));
}

void EdgeWrenchTracking::error(const WrenchesState& wrenches, Eigen::Ref<Eigen::VectorXd> e) const {
  require_rows(kTag, e.size(), wrenches.components.size());
  e = wrenches.components - reference;
}

void EdgeWrenchTracking::jacobians(const WrenchesState&,
                                   JacobianRef<EdgeWrenchTracking, 0> j) const {
  j.diagonal().setOnes();
}

}  // namespace locograph
