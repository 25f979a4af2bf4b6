#pragma once
/// EDGE_ROLLING: between two configurations every wheel rolls: no slip sideways, and forward as far
/// as it turns.
///
///     EDGE_ROLLING id id  n wheels  weights
///
/// Error (2 for each wheel) [m], with Δc the horizontal displacement of the wheel's centre, ā the
/// mean of the two axles, h̄ = ā × ẑ the mean heading:
///   lateral        Δc · ā
///   longitudinal   Δc · h̄ − r (Δφ + Δψ), φ the wheel joint, ψ the pitch of its carrier about the
///   axle
/// The trapezoidal rule for a wheel that steers evenly while its centre moves straight: exact for
/// the lateral part when Δc lies along the mean heading, short by Δθ²/12 of the path in the
/// longitudinal part when it steers by Δθ; on a circular arc through Δθ by Δθ²/6. Steering is
/// whatever turns the axle.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/wheels_edge.h>

namespace locograph {

struct EdgeRolling : WheelsEdge<VertexConfiguration, VertexConfiguration> {
  static constexpr std::string_view kTag = "EDGE_ROLLING";
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
