#pragma once
/// EDGE_BALANCE: the contact wrenches hold the robot against gravity.
///
///     EDGE_BALANCE configuration wrenches  weights
///
/// Error (6): the six base rows of Σ J_iᵀ w_i − g(q): force [N] and moment about the base's origin
/// [N m] left over, along the base axes. Zero when the robot is in static balance. Robots with a
/// floating base only.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/row_labels.h>
#include <locograph/plugins/configuration/vertex_configuration.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>

namespace locograph {

struct EdgeBalance : WeightedEdge<6, VertexConfiguration, VertexWrenches> {
  static constexpr std::string_view kTag = "EDGE_BALANCE";
  static constexpr ConstraintKind kConstraint = ConstraintKind::kEquality;

  EdgeBalance() = default;
  /// Weights of the three rows of the force and of the moment.
  EdgeBalance(double force, double moment) {
    weights << force, force, force, moment, moment, moment;
  }

  void error(const ConfigurationState& q, const WrenchesState& wrenches,
             Eigen::Ref<Eigen::Matrix<double, 6, 1>> e) const;
  void jacobians(const ConfigurationState& q, const WrenchesState& wrenches,
                 JacobianRef<EdgeBalance, 0> by_q, JacobianRef<EdgeBalance, 1> by_wrenches) const;
  RowLabel row_label(int row) const { return pose_row(row, "N", "N m"); }
  /// A part of the robot's weight.
  double row_tolerance(int, const VertexConfiguration& q, const VertexWrenches&) const;
};
LOCOGRAPH_REGISTER_EDGE(EdgeBalance::kTag, EdgeBalance)
extern template class TypedEdgePool<EdgeBalance>;

}  // namespace locograph
