#pragma once
/// EDGE_SELF_COLLISION: keeps the links of a robot a margin away from each other.
///
///     EDGE_SELF_COLLISION id  n margin  weights
///
/// Error (pairs of links, RobotParameter::self_collision.pairs) [m]: max(0, margin − d), d the
/// signed distance of the two links' nearest capsules: that of their axes less both radii, so that
/// it goes on growing while the axes approach. Capsules and spheres of the URDF are exact; of other
/// shapes d is never above the distance, and below it by at most kSelfOvershoot_m for each (more
/// where a shape would need too many spheres or capsules).
///
/// Pairs whose bounding spheres are further apart than the margin cost one comparison, pairs
/// without weight nothing: their error is zero. Where the nearest capsules change, d has a kink;
/// where axes meet, one of the possible gradients is taken.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/limit_kind.h>
#include <locograph/plugins/configuration/row_labels.h>

#include <vector>

namespace locograph {

struct EdgeSelfCollision : WeightedEdge<Eigen::Dynamic, VertexConfiguration> {
  static constexpr bool kOneSided = true;
  static constexpr std::string_view kTag = "EDGE_SELF_COLLISION";
  double margin_m = 0.01;  ///< below 0: how deep capsules may be in each other
  auto fields() { return std::tie(margin_m); }
  void bind(const Parameters& parameters) {
    require_margin(kTag, margin_m, -ranges::kCoordinate_m);
    require_fitting_robot(parameters, kTag, dimension(), [](const RobotParameter& p) {
      return static_cast<long>(p.self_collision.pairs.size());
    });
  }

  EdgeSelfCollision() = default;
  EdgeSelfCollision(const RobotParameter& robot, double margin_m, double weight);

  void error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& q, JacobianRef<EdgeSelfCollision, 0> j) const;
  double row_tolerance(int) const { return margin_tolerance(margin_m); }
  RowLabel row_label(int row, const VertexConfiguration& q) const;
};

/// A pair of RobotParameter::self_collision and its distance.
struct NearPair {
  int pair;
  double distance_m;
};

/// The pairs with a weight whose distance is below `limit`, in their order, and, one behind the
/// other, the gradients of their distances: tangent_size numbers each.
void find_near_pairs(const ConfigurationState& q, const Eigen::VectorXd& weights, double limit,
                     std::vector<NearPair>& pairs, std::vector<double>& gradients);

LOCOGRAPH_REGISTER_EDGE(EdgeSelfCollision::kTag, EdgeSelfCollision)
extern template class TypedEdgePool<EdgeSelfCollision>;

}  // namespace locograph
