#pragma once
/// EDGE_SWEPT_OBSTACLE_DISTANCE: on the way from one configuration to the next, too, the robot's
/// collision spheres keep a margin away from the world.
///
///     EDGE_SWEPT_OBSTACLE_DISTANCE id id  n world margin samples  weights
///
/// Error (number of spheres) [m], for a sphere of radius r whose centre goes straight from c_a to
/// c_b: with ρ = r + margin, N samples at s_k = (k + ½)/N and half a gap h = |c_b − c_a| / (2N),
///   max(0, max_k √(ρ² + h²) − d(c(s_k), t(s_k))),   d the signed distance of the PARAMS_WORLD
/// or the one bound in its place.
/// Times are interpolated like the centres, so moving obstacles are met where they are by then.
///
/// Nothing between the samples is missed: if somewhere on the way the distance falls below ρ and is
/// smallest there, c − p is normal to the way, p the nearest point of the obstacle, and the sample
/// next to it sees p within √(ρ² + h²). Too few samples make the edge pessimistic (by h²/2ρ where
/// h is small), never blind. An obstacle that moves counts with the way relative to it: h is half
/// the gap of c_b − c_a − (its displacement), and more by how far it turns its surface; it is taken
/// to move evenly between the two times. What comes straight towards the robot is nearest at the
/// end of the step, which is one more sample then, with ρ as it is: the last step of a window has
/// no next one. One that is there for a part of the step counts all along it. A map answers with
/// max_distance() at most: where √(ρ² + h²) exceeds that, the step counts as violated, unknown as
/// it is.
///
/// Not covered: the two ends themselves where nothing moves, which are EDGE_OBSTACLE_DISTANCE's,
/// and the arc by which a centre leaves its chord, θ² R/8 for a turn by θ about an axis at distance
/// R (3 mm for 0.2 rad and 0.6 m): the margin must leave room for it.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/limit_kind.h>
#include <locograph/plugins/configuration/row_labels.h>

namespace locograph {

struct EdgeSweptObstacleDistance
    : WeightedEdge<Eigen::Dynamic, VertexConfiguration, VertexConfiguration> {
  static constexpr bool kOneSided = true;
  static constexpr std::string_view kTag = "EDGE_SWEPT_OBSTACLE_DISTANCE";
  static constexpr int kMostSamples = 1000;
  int world_number = 0;
  double margin_m = 0.05;                       ///< ≥ 0
  int samples = 2;                              ///< 1 to kMostSamples
  std::shared_ptr<const WorldParameter> world;  ///< looked up by bind()
  auto fields() { return std::tie(world_number, margin_m, samples); }
  void bind(const Parameters& parameters);

  EdgeSweptObstacleDistance() = default;
  EdgeSweptObstacleDistance(const RobotParameter& robot, int world_number, double margin_m,
                            int samples, double weight);

  void error(const ConfigurationState& a, const ConfigurationState& b,
             Eigen::Ref<Eigen::VectorXd> e, const Bindings& bindings) const;
  void jacobians(const ConfigurationState& a, const ConfigurationState& b,
                 JacobianRef<EdgeSweptObstacleDistance, 0> ja,
                 JacobianRef<EdgeSweptObstacleDistance, 1> jb, const Bindings& bindings) const;
  double row_tolerance(int) const { return margin_tolerance(margin_m); }
  RowLabel row_label(int row, const VertexConfiguration& a, const VertexConfiguration&) const {
    return sphere_row(*a.robot, row, "near an obstacle on its way");
  }
};
LOCOGRAPH_REGISTER_EDGE(EdgeSweptObstacleDistance::kTag, EdgeSweptObstacleDistance)
extern template class TypedEdgePool<EdgeSweptObstacleDistance>;

}  // namespace locograph
