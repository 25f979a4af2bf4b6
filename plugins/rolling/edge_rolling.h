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
#include <locograph/plugins/configuration/edge_fit.h>

namespace locograph {

struct EdgeRolling : WeightedEdge<Eigen::Dynamic, VertexConfiguration, VertexConfiguration> {
  static constexpr std::string_view kTag = "EDGE_ROLLING";
  int wheels_number = 0;
  std::shared_ptr<const WheelsParameter> wheels;  ///< looked up by bind()
  std::shared_ptr<const RobotParameter> robot;    ///< whose wheels they are, likewise
  auto fields() { return std::tie(wheels_number); }
  void bind(const Parameters& parameters) {
    wheels = parameters.get<WheelsParameter>(wheels_number);
    robot = parameters.get<RobotParameter>(wheels->robot_number);
    require_rows(kTag, dimension(), 2 * static_cast<long>(wheels->wheels.size()));
  }

  EdgeRolling() = default;
  EdgeRolling(const WheelsParameter& wheels, int wheels_number, double weight);

  void error(const ConfigurationState& a, const ConfigurationState& b,
             Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& a, const ConfigurationState& b,
                 JacobianRef<EdgeRolling, 0> ja, JacobianRef<EdgeRolling, 1> jb) const;
};
LOCOGRAPH_REGISTER_EDGE(EdgeRolling::kTag, EdgeRolling)
extern template class TypedEdgePool<EdgeRolling>;

}  // namespace locograph
