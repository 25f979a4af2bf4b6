#pragma once
/// EDGE_GROUND_DISTANCE: keeps the robot's collision spheres a margin above the ground, z = 0.
///
///     EDGE_GROUND_DISTANCE id  n margin  weights
///
///     EdgeGroundDistance above(*robot, 0.005, 1e4);
///     above.weights[i] = 0.0;                      // sphere i is part of a foot: it may touch
///     graph.add_edge(above, configuration);
///
/// Error (number of spheres) [m]: max(0, margin + r − z) for a sphere of radius r at height z.
/// Linear in the depth, so there is a way out from below the ground.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/limit_kind.h>

namespace locograph {

struct EdgeGroundDistance : WeightedEdge<Eigen::Dynamic, VertexConfiguration> {
  static constexpr bool kOneSided = true;
  static constexpr std::string_view kTag = "EDGE_GROUND_DISTANCE";
  double margin_m = 0.0;
  auto fields() { return std::tie(margin_m); }
  void bind(const Parameters& parameters) {
    require_margin(kTag, margin_m);
    require_fitting_robot(parameters, kTag, dimension(), [](const RobotParameter& p) {
      return static_cast<long>(p.spheres.size());
    });
  }

  EdgeGroundDistance() = default;
  EdgeGroundDistance(const RobotParameter& robot, double margin_m, double weight);

  void error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const;
  double row_tolerance(int) const { return margin_tolerance(margin_m); }
  void jacobians(const ConfigurationState& q, JacobianRef<EdgeGroundDistance, 0> j) const;
};
LOCOGRAPH_REGISTER_EDGE(EdgeGroundDistance::kTag, EdgeGroundDistance)
extern template class TypedEdgePool<EdgeGroundDistance>;

}  // namespace locograph
