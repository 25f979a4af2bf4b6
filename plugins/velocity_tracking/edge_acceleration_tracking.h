#pragma once
/// EDGE_ACCELERATION_TRACKING: keeps the acceleration over three consecutive configurations near
/// that of the global plan, so that a detour bends smoothly and does not shake the robot.
///
///     EDGE_ACCELERATION_TRACKING id id id  n acceleration…  weights
///
/// Error (tangent size): 2 ((c ⊖ b)/Δt₂ + (a ⊖ b)/Δt₁) / (Δt₁ + Δt₂) − acceleration, all in the
/// base frame of b: translation [m/s²], rotation vector [rad/s²], joints. The second derivative of
/// the parabola through the three. Throws Error where the times do not increase.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/row_labels.h>

namespace locograph {

struct EdgeAccelerationTracking
    : WeightedEdge<Eigen::Dynamic, VertexConfiguration, VertexConfiguration, VertexConfiguration> {
  static constexpr std::string_view kTag = "EDGE_ACCELERATION_TRACKING";
  Eigen::VectorXd acceleration;  ///< of the plan
  auto fields() { return std::tie(acceleration); }
  void resize(int n) {
    weights.resize(n);
    acceleration.resize(n);
  }
  void bind(const Parameters& parameters) {
    require_rows(kTag, acceleration.size(), dimension());
    require_fitting_robot(parameters, kTag, dimension(),
                          [](const RobotParameter& p) { return p.robot->tangent_size(); });
  }

  EdgeAccelerationTracking() = default;
  EdgeAccelerationTracking(const Eigen::VectorXd& acceleration, const Eigen::VectorXd& weights);

  int diagonal_from(const ConfigurationState& q) const { return q.model().base_tangent_size(); }
  void error(const ConfigurationState& a, const ConfigurationState& b, const ConfigurationState& c,
             Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& a, const ConfigurationState& b,
                 const ConfigurationState& c, JacobianRef<EdgeAccelerationTracking, 0> ja,
                 JacobianRef<EdgeAccelerationTracking, 1> jb,
                 JacobianRef<EdgeAccelerationTracking, 2> jc) const;
  RowLabel row_label(int row, const VertexConfiguration& a, const VertexConfiguration&,
                     const VertexConfiguration&) const {
    return tangent_row(*a.robot->robot, row);
  }
};
LOCOGRAPH_REGISTER_EDGE(EdgeAccelerationTracking::kTag, EdgeAccelerationTracking)
extern template class TypedEdgePool<EdgeAccelerationTracking>;

}  // namespace locograph
