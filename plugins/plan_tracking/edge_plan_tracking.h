#pragma once
/// EDGE_PLAN_TRACKING: keeps a configuration near the one that the global plan has there.
///
///     EDGE_PLAN_TRACKING id  n reference…  weights
///
/// Error (tangent size): reference ⊖ q: base translation [m] and rotation vector [rad] in the
/// reference's base frame, then joints. Ω per coordinate: a weight of zero leaves it free.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/vertex_configuration.h>

namespace locograph {

struct EdgePlanTracking : WeightedEdge<Eigen::Dynamic, VertexConfiguration> {
  Eigen::VectorXd reference;  ///< a configuration
  auto fields() { return std::tie(reference); }
  /// n is the tangent size: a floating base has one number more in its configuration.
  void resize(int n) { weights.resize(n); }

  EdgePlanTracking() = default;
  EdgePlanTracking(const Eigen::VectorXd& reference, const Eigen::VectorXd& weights);

  void error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& q, JacobianRef<EdgePlanTracking, 0> j) const;
};
LOCOGRAPH_REGISTER_EDGE("EDGE_PLAN_TRACKING", EdgePlanTracking)
extern template class TypedEdgePool<EdgePlanTracking>;

/// Inverse of the right Jacobian of SO(3): log(R exp(δ)) ≈ log R + J δ (Chirikjian 2012,
/// eq. 10.86).
Eigen::Matrix3d inverse_right_jacobian(const Eigen::Vector3d& rotation_vector);

}  // namespace locograph
