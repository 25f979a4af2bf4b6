#pragma once
/// EDGE_PLAN_TRACKING: keeps a configuration near the one that the global plan has there.
///
///     EDGE_PLAN_TRACKING id  n reference…  weights
///
/// Error (tangent size): reference ⊖ q: base translation [m] and rotation vector [rad] in the
/// reference's base frame, then joints. Ω per coordinate: a weight of zero leaves it free.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/row_labels.h>

namespace locograph {

/// A configuration inside an edge's line. Its size is the tangent size n of the edge, and one more
/// with a floating base: a number before the weights tells.
struct ReferenceConfiguration : Eigen::VectorXd {
  using Eigen::VectorXd::VectorXd;
  using Eigen::VectorXd::operator=;
  /// size() is n before.
  void read(FieldReader& in);
  void write(FieldWriter& out) const;
};

struct EdgePlanTracking : WeightedEdge<Eigen::Dynamic, VertexConfiguration> {
  static constexpr std::string_view kTag = "EDGE_PLAN_TRACKING";
  ReferenceConfiguration reference;
  auto fields() { return std::tie(reference); }
  void resize(int n) {
    weights.resize(n);
    reference.resize(n);
  }
  void bind(const Parameters& parameters) {
    require_fitting_robot(parameters, kTag, dimension(),
                          [](const RobotParameter& p) { return p.robot->tangent_size(); });
    require_fitting_robot(parameters, "reference of EDGE_PLAN_TRACKING", reference.size(),
                          [](const RobotParameter& p) { return p.robot->configuration_size(); });
  }

  EdgePlanTracking() = default;
  EdgePlanTracking(const Eigen::VectorXd& reference, const Eigen::VectorXd& weights);

  int diagonal_from(const ConfigurationState& q) const { return q.model().base_tangent_size(); }
  void error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& q, JacobianRef<EdgePlanTracking, 0> j) const;
  RowLabel row_label(int row, const VertexConfiguration& q) const {
    return tangent_row(*q.robot->robot, row);
  }
};
LOCOGRAPH_REGISTER_EDGE(EdgePlanTracking::kTag, EdgePlanTracking)
extern template class TypedEdgePool<EdgePlanTracking>;

}  // namespace locograph
