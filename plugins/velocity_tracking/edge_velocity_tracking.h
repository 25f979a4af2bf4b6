#pragma once
/// EDGE_VELOCITY_TRACKING: keeps the step between two configurations near the step that the global
/// plan makes there, so that a detour is taken smoothly.
///
///     EDGE_VELOCITY_TRACKING id id  n step…  weights
///
/// Error (tangent size): (b ⊖ a) − step, both in the base frame of a: translation [m], rotation
/// vector [rad], joints. Ω per coordinate.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/row_labels.h>

namespace locograph {

struct EdgeVelocityTracking
    : WeightedEdge<Eigen::Dynamic, VertexConfiguration, VertexConfiguration> {
  static constexpr std::string_view kTag = "EDGE_VELOCITY_TRACKING";
  Eigen::VectorXd step;  ///< of the plan
  auto fields() { return std::tie(step); }
  void resize(int n) {
    weights.resize(n);
    step.resize(n);
  }
  void bind(const Parameters& parameters) {
    require_rows(kTag, step.size(), dimension());
    require_fitting_robot(parameters, kTag, dimension(),
                          [](const RobotParameter& p) { return p.robot->tangent_size(); });
  }

  EdgeVelocityTracking() = default;
  EdgeVelocityTracking(const Eigen::VectorXd& step, const Eigen::VectorXd& weights);

  int diagonal_from(const ConfigurationState& q) const { return q.model().base_tangent_size(); }
  void error(const ConfigurationState& a, const ConfigurationState& b,
             Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& a, const ConfigurationState& b,
                 JacobianRef<EdgeVelocityTracking, 0> ja,
                 JacobianRef<EdgeVelocityTracking, 1> jb) const;
  RowLabel row_label(int row, const VertexConfiguration& a, const VertexConfiguration&) const {
    return tangent_row(*a.robot->robot, row);
  }
};
LOCOGRAPH_REGISTER_EDGE(EdgeVelocityTracking::kTag, EdgeVelocityTracking)
extern template class TypedEdgePool<EdgeVelocityTracking>;

}  // namespace locograph
