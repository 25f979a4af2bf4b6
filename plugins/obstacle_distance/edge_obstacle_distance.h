#pragma once
/// EDGE_OBSTACLE_DISTANCE: keeps the robot's collision spheres a margin away from the world.
///
///     EDGE_OBSTACLE_DISTANCE id  n world margin  weights
///
/// Error (number of spheres) [m]: max(0, margin − (d(c) − r)) for a sphere of radius r about c, d
/// the signed distance that the PARAMS_WORLD, or the one bound in its place, shows at the
/// configuration's time. Inside an obstacle it grows with the depth, so there is a way out. Links
/// that are far as a whole are looked up once.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/limit_kind.h>
#include <locograph/plugins/configuration/row_labels.h>

namespace locograph {

struct EdgeObstacleDistance : WeightedEdge<Eigen::Dynamic, VertexConfiguration> {
  static constexpr bool kOneSided = true;
  static constexpr std::string_view kTag = "EDGE_OBSTACLE_DISTANCE";
  int world_number = 0;
  double margin_m = 0.05;
  std::shared_ptr<const WorldParameter> world;  ///< looked up by bind()
  auto fields() { return std::tie(world_number, margin_m); }
  void bind(const Parameters& parameters) {
    require_margin(kTag, margin_m);
    world = parameters.get<WorldParameter>(world_number);
    require_fitting_robot(parameters, kTag, dimension(), [](const RobotParameter& p) {
      return static_cast<long>(p.spheres.size());
    });
  }

  EdgeObstacleDistance() = default;
  EdgeObstacleDistance(const RobotParameter& robot, int world_number, double margin_m,
                       double weight);

  void error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e,
             const Bindings& bindings) const;
  void jacobians(const ConfigurationState& q, JacobianRef<EdgeObstacleDistance, 0> j,
                 const Bindings& bindings) const;
  double row_tolerance(int) const { return margin_tolerance(margin_m); }
  RowLabel row_label(int row, const VertexConfiguration& q) const {
    return sphere_row(*q.robot, row, "near an obstacle");
  }
};
LOCOGRAPH_REGISTER_EDGE(EdgeObstacleDistance::kTag, EdgeObstacleDistance)
extern template class TypedEdgePool<EdgeObstacleDistance>;

}  // namespace locograph
