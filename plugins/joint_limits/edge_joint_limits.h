#pragma once
/// EDGE_JOINT_LIMITS: keeps every active joint a margin away from its limits.
///
///     EDGE_JOINT_LIMITS id  n margin  weights
///
/// Error (number of active joints) [rad or m]: max(0, lower + margin − q, q − upper + margin) for
/// each; zero for joints without limits. Linear in the violation, so that its gradient does not
/// vanish at the boundary.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/limit_kind.h>
#include <locograph/plugins/configuration/row_labels.h>

namespace locograph {

struct EdgeJointLimits : WeightedEdge<Eigen::Dynamic, VertexConfiguration> {
  static constexpr bool kOneSided = true;
  static constexpr std::string_view kTag = "EDGE_JOINT_LIMITS";
  double margin = 0.0;
  auto fields() { return std::tie(margin); }
  void bind(const Parameters& parameters) {
    require_margin(kTag, margin);
    require_fitting_robot(parameters, kTag, dimension(),
                          [](const RobotParameter& p) { return p.robot->active_joint_count(); });
  }

  EdgeJointLimits() = default;
  EdgeJointLimits(const Robot& robot, double margin, double weight);

  void error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& q, JacobianRef<EdgeJointLimits, 0> j) const;
  double row_tolerance(int) const { return margin_tolerance(margin); }
  RowLabel row_label(int row, const VertexConfiguration& q) const;
};
LOCOGRAPH_REGISTER_EDGE(EdgeJointLimits::kTag, EdgeJointLimits)
extern template class TypedEdgePool<EdgeJointLimits>;

}  // namespace locograph
