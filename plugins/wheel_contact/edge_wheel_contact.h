#pragma once
/// EDGE_WHEEL_CONTACT: every wheel stands upright on the ground z = 0.
///
///     EDGE_WHEEL_CONTACT id  n wheels  weights
///
/// Error (2 for each wheel): height of the wheel's lowest point, c_z − r √(1 − a_z²) [m], for a
/// disc of radius r about c with axle a; and a_z, the sine of the axle's tilt.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>

namespace locograph {

struct EdgeWheelContact : WeightedEdge<Eigen::Dynamic, VertexConfiguration> {
  static constexpr std::string_view kTag = "EDGE_WHEEL_CONTACT";
  int wheels_number = 0;
  std::shared_ptr<const WheelsParameter> wheels;  ///< looked up by bind()
  std::shared_ptr<const RobotParameter> robot;    ///< whose wheels they are, likewise
  auto fields() { return std::tie(wheels_number); }
  void bind(const Parameters& parameters) {
    wheels = parameters.get<WheelsParameter>(wheels_number);
    robot = parameters.get<RobotParameter>(wheels->robot_number);
    require_rows(kTag, dimension(), 2 * static_cast<long>(wheels->wheels.size()));
  }

  EdgeWheelContact() = default;
  EdgeWheelContact(const WheelsParameter& wheels, int wheels_number, double weight);

  void error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& q, JacobianRef<EdgeWheelContact, 0> j) const;
};
LOCOGRAPH_REGISTER_EDGE(EdgeWheelContact::kTag, EdgeWheelContact)
extern template class TypedEdgePool<EdgeWheelContact>;

}  // namespace locograph
