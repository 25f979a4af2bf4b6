#pragma once
/// EDGE_ROLLING: between two configurations every wheel rolls: no slip sideways, and forward as far
/// as it turns.
///
///     EDGE_ROLLING id id  n wheels  weights
///
/// Error (2 for each wheel) [m], with Δc the horizontal displacement of the wheel's centre, ā the
/// horizontal unit vector midway between the two axles, h̄ = ā × ẑ the mean heading, Δθ the angle
/// between the axles seen from above:
///   lateral        Δc · ā, and away from zero by r max(0, |Δθ| − π/2)
///   longitudinal   Δc · h̄ − r (Δφ + Δψ), φ the wheel joint, ψ the pitch of its carrier about the
///   axle
/// The midpoint rule for a wheel that steers evenly. Exact for the lateral part when Δc lies along
/// the mean heading. In the longitudinal part, of a wheel that steers by Δθ while its centre moves
/// straight, too much by Δθ²/24 of the way, the mean of cos over ±Δθ/2; on a circular arc through
/// Δθ too little by as much, the chord instead of the arc. Steering is whatever turns the axle.
///
/// A wheel that is steered half round in one step looks as if it had not been steered at all: what
/// exceeds a quarter turn is an error by itself, whatever the wheel's way. It pulls the wheel back
/// round; a larger turn takes several steps.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/wheels_edge.h>

namespace locograph {

struct EdgeRolling : WheelsEdge<VertexConfiguration, VertexConfiguration> {
  static constexpr std::string_view kTag = "EDGE_ROLLING";
  static constexpr ConstraintKind kConstraint = ConstraintKind::kEquality;
  static constexpr double kTolerance = 1.5e-3;  ///< m; the judge allows 5 mm between vertices
  void bind(const Parameters& parameters) { bind_wheels(parameters, kTag); }

  EdgeRolling() = default;
  EdgeRolling(const WheelsParameter& wheels, int wheels_number, double weight)
      : WheelsEdge(wheels, wheels_number, weight) {}

  void error(const ConfigurationState& a, const ConfigurationState& b,
             Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& a, const ConfigurationState& b,
                 JacobianRef<EdgeRolling, 0> ja, JacobianRef<EdgeRolling, 1> jb) const;
  RowLabel row_label(int row) const {
    return {wheels->wheels[row / 2].link_name + (row % 2 == 0 ? " lateral" : " longitudinal"), "m"};
  }
};
LOCOGRAPH_REGISTER_EDGE(EdgeRolling::kTag, EdgeRolling)
extern template class TypedEdgePool<EdgeRolling>;

}  // namespace locograph
