#pragma once
/// EDGE_COM: a task: brings the robot's centre of mass to a point, each coordinate by its weight.
///
///     EDGE_COM id  x y z  weights
///
///     // above (0.1, 0), at whatever height
///     const EdgeCom above({0.1, 0.0, 0.0}, {1.0, 1.0, 0.0});
///     graph.add_edge(above, configuration);
///
/// Error (3): centre of mass − target [m], along the world axes. A weight of zero leaves a
/// coordinate free. Throws Error for a robot without a mass.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/row_labels.h>

namespace locograph {

struct EdgeCom : WeightedEdge<3, VertexConfiguration> {
  static constexpr std::string_view kTag = "EDGE_COM";
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  auto fields() { return std::tie(target); }
  void bind(const Parameters& parameters) const;

  EdgeCom() = default;
  EdgeCom(const Eigen::Vector3d& target, const Eigen::Vector3d& weights);

  void error(const ConfigurationState& q, Eigen::Ref<Eigen::Vector3d> e) const;
  void jacobians(const ConfigurationState& q, JacobianRef<EdgeCom, 0> j) const;
  RowLabel row_label(int row) const { return pose_row(row); }
};
LOCOGRAPH_REGISTER_EDGE(EdgeCom::kTag, EdgeCom)
extern template class TypedEdgePool<EdgeCom>;

}  // namespace locograph
