#pragma once
/// EDGE_WRENCH_TRACKING: keeps contact wrenches near those that a plan states.
///
///     EDGE_WRENCH_TRACKING wrenches  n reference…  weights
///
/// Error (n): the components less the reference [N, N m]. Where the plan stays as it is, so do its
/// wrenches; where it moves, they change by as little as balances it.

#include <locograph/plugins/static_balance/edge_wrench_norm.h>

namespace locograph {

struct EdgeWrenchTracking : WeightedEdge<Eigen::Dynamic, VertexWrenches> {
  static constexpr std::string_view kTag = "EDGE_WRENCH_TRACKING";
  Eigen::VectorXd reference;
  auto fields() { return std::tie(reference); }
  void resize(int n) {
    weights.resize(n);
    reference.resize(n);
  }

  EdgeWrenchTracking() = default;
  /// reference: what the wrenches are now.
  EdgeWrenchTracking(const VertexWrenches& wrenches, double weight) : reference(wrenches.state) {
    weights.setConstant(reference.size(), weight);
  }

  /// Throws Error for other rows than the vertex has components.
  void check(const Graph& graph) const;
  void error(const WrenchesState& wrenches, Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const WrenchesState& wrenches, JacobianRef<EdgeWrenchTracking, 0> j) const;
  RowLabel row_label(int row, const VertexWrenches& wrenches) const {
    return EdgeWrenchNorm().row_label(row, wrenches);
  }
};
LOCOGRAPH_REGISTER_EDGE(EdgeWrenchTracking::kTag, EdgeWrenchTracking)
extern template class TypedEdgePool<EdgeWrenchTracking>;

}  // namespace locograph
