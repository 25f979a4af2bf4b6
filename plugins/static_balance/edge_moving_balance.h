#pragma once
/// EDGE_MOVING_BALANCE: the contact wrenches hold a robot that moves through three consecutive
/// configurations.
///
///     EDGE_MOVING_BALANCE here wrenches before after  load (6)  weights
///
/// Error (6), force [N] and moment about the base's origin [N m] along the base axes, all at the
/// middle configuration:
///
///   (Σ J_iᵀ w_i − g(q))_base − Σ m_k [a_k; (p_k − o) × a_k] − load
///
/// p_k are the centres of mass of the links, m_k their masses, o the base's origin;
/// a_k = 2 (Δp₂/Δt₂ − Δp₁/Δt₁) / (Δt₁ + Δt₂), the second derivative of the parabola through the
/// three. What a link takes to be turned about its own centre of mass is left out, as is how the
/// robot moves between configurations; load is there for both: with a motion's own remainder as its
/// load, the motion is balanced, and one that differs from it a little is balanced up to how the
/// remainder changes. Robots with a floating base only. Throws Error where the times do not
/// increase.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/row_labels.h>
#include <locograph/plugins/configuration/vertex_configuration.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>

namespace locograph {

struct EdgeMovingBalance : WeightedEdge<6, VertexConfiguration, VertexWrenches, VertexConfiguration,
                                        VertexConfiguration> {
  static constexpr std::string_view kTag = "EDGE_MOVING_BALANCE";
  static constexpr ConstraintKind kConstraint = ConstraintKind::kEquality;
  Eigen::Matrix<double, 6, 1> load = Eigen::Matrix<double, 6, 1>::Zero();
  auto fields() { return std::tie(load); }

  EdgeMovingBalance() = default;
  /// Weights of the three rows of the force and of the moment.
  EdgeMovingBalance(double force, double moment) {
    weights << force, force, force, moment, moment, moment;
  }

  void error(const ConfigurationState& here, const WrenchesState& wrenches,
             const ConfigurationState& before, const ConfigurationState& after,
             Eigen::Ref<Eigen::Matrix<double, 6, 1>> e) const;
  void jacobians(const ConfigurationState& here, const WrenchesState& wrenches,
                 const ConfigurationState& before, const ConfigurationState& after,
                 JacobianRef<EdgeMovingBalance, 0> by_here,
                 JacobianRef<EdgeMovingBalance, 1> by_wrenches,
                 JacobianRef<EdgeMovingBalance, 2> by_before,
                 JacobianRef<EdgeMovingBalance, 3> by_after) const;
  RowLabel row_label(int row) const { return pose_row(row, "N", "N m"); }
  /// A part of the robot's weight.
  double row_tolerance(int, const VertexConfiguration& here, const VertexWrenches&,
                       const VertexConfiguration&, const VertexConfiguration&) const;
};
LOCOGRAPH_REGISTER_EDGE(EdgeMovingBalance::kTag, EdgeMovingBalance)
extern template class TypedEdgePool<EdgeMovingBalance>;

}  // namespace locograph
