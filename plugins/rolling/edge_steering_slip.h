#pragma once
/// EDGE_STEERING_SLIP: how far the wheels of a stance slip sideways on the way between two
/// configurations, when they steer while they roll.
///
///     EDGE_STEERING_SLIP id id  n stance max_slip  weights
///
///     graph.add_edge(EdgeSteeringSlip(*stance, 20, 0.002, 1e4), before, after);
///
/// Error (one for each wheel that is not locked) [m]: max(0, |s Δθ| / 8 − max_slip), s the way of
/// the wheel along its mean heading, Δθ the angle between its axles about the normal of its plane.
///
/// Between two configurations a wheel moves along a line and steers evenly, as a Motion does
/// (check/motion.h): where EDGE_ROLLING holds at both ends, the heading is off the line by Δθ/2
/// there and on it half-way. What slips sideways is ∫ s Δθ (1/2 − t) dt: 0 over the whole way, but
/// s Δθ / 8 half-way. Steps of half the time have a quarter of it.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/limit_kind.h>
#include <locograph/plugins/configuration/stance_parameter.h>

namespace locograph {

struct EdgeSteeringSlip : WeightedEdge<Eigen::Dynamic, VertexConfiguration, VertexConfiguration> {
  static constexpr bool kOneSided = true;
  static constexpr std::string_view kTag = "EDGE_STEERING_SLIP";
  static constexpr double kTolerance = 1e-4;  ///< m
  int stance_number = 0;
  double max_slip_m = 0.0;
  std::shared_ptr<const StanceParameter> stance;  ///< looked up by bind()
  auto fields() { return std::tie(stance_number, max_slip_m); }
  /// Throws Error for a negative max_slip, a stance without wheels that roll, or one that does not
  /// fit the rows.
  void bind(const Parameters& parameters);

  EdgeSteeringSlip() = default;
  EdgeSteeringSlip(const StanceParameter& stance, int stance_number, double max_slip_m,
                   double weight);

  void error(const ConfigurationState& a, const ConfigurationState& b,
             Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& a, const ConfigurationState& b,
                 JacobianRef<EdgeSteeringSlip, 0> ja, JacobianRef<EdgeSteeringSlip, 1> jb) const;
  RowLabel row_label(int row) const;
};
LOCOGRAPH_REGISTER_EDGE(EdgeSteeringSlip::kTag, EdgeSteeringSlip)
extern template class TypedEdgePool<EdgeSteeringSlip>;

}  // namespace locograph
