#include <locograph/core/graph.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/row_labels.h>
#include <locograph/plugins/static_balance/edge_wrench_norm.h>

namespace locograph {

template class TypedEdgePool<EdgeWrenchNorm>;

void EdgeWrenchNorm::check(const Graph& graph) const {
  require_rows(kTag, dimension(), graph.dimension(vertices[0]));
}

void EdgeWrenchNorm::error(const WrenchesState& wrenches, Eigen::Ref<Eigen::VectorXd> e) const {
  require_rows(kTag, e.size(), wrenches.components.size());
  e = wrenches.components;
}

void EdgeWrenchNorm::jacobians(const WrenchesState&, JacobianRef<EdgeWrenchNorm, 0> j) const {
  j.diagonal().setOnes();
}

RowLabel EdgeWrenchNorm::row_label(int row, const VertexWrenches& wrenches) const {
  for (const auto& contact : *wrenches.contacts) {
    const std::span<const int> components = contact->cone->components();
    const int count = static_cast<int>(components.size());
    if (row < count) {
      RowLabel label = pose_row(components[row], "N", "N m");
      label.name = contact->contact.name() + " wrench " + label.name;
      return label;
    }
    row -= count;
  }
  return {};
}

}  // namespace locograph
