#pragma once
/// EDGE_MEASUREMENT: what was measured when a plan was carried out, of one configuration.
///
///     EDGE_MEASUREMENT configuration wrenches  n plan_time torques…  weights
///
/// Ties the configuration that was measured to the wrenches measured there, and says which time of
/// the plan it belongs to [s] and what the joints did (n active joints, N m or N).
///
/// Error (n): the torques less those that hold the robot still against its weight and the wrenches,
/// g(q) − Σ J_iᵀ w_i: what goes into acceleration.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/row_labels.h>
#include <locograph/plugins/configuration/vertex_configuration.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>

namespace locograph {

struct EdgeMeasurement : WeightedEdge<Eigen::Dynamic, VertexConfiguration, VertexWrenches> {
  static constexpr std::string_view kTag = "EDGE_MEASUREMENT";
  double plan_time_s = 0.0;
  Eigen::VectorXd torques;
  auto fields() { return std::tie(plan_time_s, torques); }
  void resize(int n) {
    weights.resize(n);
    torques.resize(n);
  }
  /// Throws Error for a time or torques that no plan and no joint has.
  void bind(const Parameters& parameters);

  EdgeMeasurement() = default;
  /// Weights make errors shares of the efforts; zero where a joint has none.
  EdgeMeasurement(const Robot& robot, double plan_time_s, Eigen::VectorXd torques);

  void error(const ConfigurationState& q, const WrenchesState& wrenches,
             Eigen::Ref<Eigen::VectorXd> e) const;
  RowLabel row_label(int row, const VertexConfiguration& q, const VertexWrenches&) const;
};
LOCOGRAPH_REGISTER_EDGE(EdgeMeasurement::kTag, EdgeMeasurement)
extern template class TypedEdgePool<EdgeMeasurement>;

}  // namespace locograph
