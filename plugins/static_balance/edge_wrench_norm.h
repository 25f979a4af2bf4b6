#pragma once
/// EDGE_WRENCH_NORM: of all wrenches that balance, the smallest.
///
///     EDGE_WRENCH_NORM wrenches  n  weights
///
/// Error (n): the components [N, N m] themselves. A small weight makes the wrenches unique, as a
/// Schur complement needs them to be; a large one on single rows takes components away (a foot that
/// cannot bear yaw).

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>

namespace locograph {

struct EdgeWrenchNorm : WeightedEdge<Eigen::Dynamic, VertexWrenches> {
  static constexpr std::string_view kTag = "EDGE_WRENCH_NORM";

  EdgeWrenchNorm() = default;
  EdgeWrenchNorm(const VertexWrenches& wrenches, double weight) {
    weights.setConstant(wrenches.dimension(), weight);
  }

  /// Throws Error for other rows than the vertex has components.
  void check(const Graph& graph) const;
  void error(const WrenchesState& wrenches, Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const WrenchesState& wrenches, JacobianRef<EdgeWrenchNorm, 0> j) const;
  RowLabel row_label(int row, const VertexWrenches& wrenches) const;
};
LOCOGRAPH_REGISTER_EDGE(EdgeWrenchNorm::kTag, EdgeWrenchNorm)
extern template class TypedEdgePool<EdgeWrenchNorm>;

}  // namespace locograph
