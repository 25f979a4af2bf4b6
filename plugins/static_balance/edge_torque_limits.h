#pragma once
/// EDGE_TORQUE_LIMITS: no joint needs more than its effort limit to hold the robot still.
///
///     EDGE_TORQUE_LIMITS configuration wrenches  n fraction  weights
///
/// Error (active joints): max(0, |τ_i| − fraction · effort_i) with τ = g(q) − Σ J_iᵀ w_i, the
/// torque [N m] or force [N] of each joint. A joint whose URDF gives no effort is not limited; one
/// whose effort is zero or less is an Error: no such joint holds anything.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/row_labels.h>
#include <locograph/plugins/configuration/vertex_configuration.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>

namespace locograph {

struct EdgeTorqueLimits : WeightedEdge<Eigen::Dynamic, VertexConfiguration, VertexWrenches> {
  static constexpr bool kOneSided = true;
  static constexpr std::string_view kTag = "EDGE_TORQUE_LIMITS";
  double fraction = 1.0;
  auto fields() { return std::tie(fraction); }
  void bind(const Parameters& parameters);

  EdgeTorqueLimits() = default;
  /// Throws Error for a joint whose effort limit is not positive.
  EdgeTorqueLimits(const Robot& robot, double fraction, double weight);

  void error(const ConfigurationState& q, const WrenchesState& wrenches,
             Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& q, const WrenchesState& wrenches,
                 JacobianRef<EdgeTorqueLimits, 0> by_q,
                 JacobianRef<EdgeTorqueLimits, 1> by_wrenches) const;
  RowLabel row_label(int row, const VertexConfiguration& q, const VertexWrenches&) const;
  /// Half of what `fraction` leaves of the effort.
  double row_tolerance(int row, const VertexConfiguration& q, const VertexWrenches&) const;
};
LOCOGRAPH_REGISTER_EDGE(EdgeTorqueLimits::kTag, EdgeTorqueLimits)
extern template class TypedEdgePool<EdgeTorqueLimits>;

}  // namespace locograph
