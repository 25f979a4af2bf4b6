#pragma once
/// EDGE_ROLLING: between two configurations every wheel of a stance rolls: no slip sideways, and
/// forward as far as it turns; a locked one stays where it is.
///
///     EDGE_ROLLING id id  n stance  weights
///
///     graph.add_edge(EdgeRolling(*stance, 20, 1e5), before, after);   // stance: PARAMS_STANCE 20
///
/// Error (2 for each wheel, 3 for a locked one) [m]. All along the plane that the wheel's contact
/// lies in, n its normal: Δc the displacement of the wheel's centre, ā the unit vector midway
/// between the two axles, h̄ = ā × n the mean heading, Δθ the angle between the axles about n:
///   lateral        Δc · ā, and away from zero by r max(0, |Δθ| − π/2)
///   longitudinal   Δc · h̄ − r (Δφ + Δψ), φ the wheel joint, ψ the pitch of its carrier about the
///                  axle; of a locked wheel Δc · h̄
///   turned         of a locked wheel, r (Δφ + Δψ)
/// The midpoint rule for a wheel that steers evenly. Exact for the lateral part when Δc lies along
/// the mean heading. In the longitudinal part, of a wheel that steers by Δθ while its centre moves
/// straight, too much by Δθ²/24 of the way, the mean of cos over ±Δθ/2; on a circular arc through
/// Δθ too little by as much, the chord instead of the arc. Steering is whatever turns the axle.
///
/// A wheel that is steered half round in one step looks as if it had not been steered at all: what
/// exceeds a quarter turn is an error by itself, whatever the wheel's way. It pulls the wheel back
/// round; a larger turn takes several steps.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/stance_parameter.h>

namespace locograph {

struct EdgeRolling : WeightedEdge<Eigen::Dynamic, VertexConfiguration, VertexConfiguration> {
  static constexpr std::string_view kTag = "EDGE_ROLLING";
  static constexpr ConstraintKind kConstraint = ConstraintKind::kEquality;
  /// m, of steps of 0.08 m or more: with what wheels that steer may slip half-way of two steps,
  /// 1.9 mm each to either side, it stays within the 5 mm that the judge allows in 0.1 m of their
  /// way. Where steps are shorter, plans say less for the edge (planners/plan/plan_edges.h).
  static constexpr double kTolerance = 1e-3;
  int stance_number = 0;
  std::shared_ptr<const StanceParameter> stance;  ///< looked up by bind()
  auto fields() { return std::tie(stance_number); }
  /// Throws Error for a stance without wheels, or one that does not fit the rows.
  void bind(const Parameters& parameters);

  EdgeRolling() = default;
  EdgeRolling(const StanceParameter& stance, int stance_number, double weight);

  void error(const ConfigurationState& a, const ConfigurationState& b,
             Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& a, const ConfigurationState& b,
                 JacobianRef<EdgeRolling, 0> ja, JacobianRef<EdgeRolling, 1> jb) const;
  RowLabel row_label(int row) const;
};
LOCOGRAPH_REGISTER_EDGE(EdgeRolling::kTag, EdgeRolling)
extern template class TypedEdgePool<EdgeRolling>;

}  // namespace locograph
