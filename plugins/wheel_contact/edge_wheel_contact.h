#pragma once
/// EDGE_WHEEL_CONTACT: every wheel stands upright on the ground z = 0.
///
///     EDGE_WHEEL_CONTACT id  n wheels  weights
///
/// Error (2 for each wheel): height of the wheel's lowest point, c_z − r √(1 − a_z²) [m], for a
/// disc of radius r about c with axle a; and a_z, the sine of the axle's tilt.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/wheels_edge.h>

namespace locograph {

struct EdgeWheelContact : WheelsEdge<VertexConfiguration> {
  static constexpr std::string_view kTag = "EDGE_WHEEL_CONTACT";
  void bind(const Parameters& parameters) { bind_wheels(parameters, kTag); }

  EdgeWheelContact() = default;
  EdgeWheelContact(const WheelsParameter& wheels, int wheels_number, double weight)
      : WheelsEdge(wheels, wheels_number, weight) {}

  void error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& q, JacobianRef<EdgeWheelContact, 0> j) const;
  RowLabel row_label(int row) const {
    const std::string& wheel = wheels->wheels[row / 2].link_name;
    // The sine of the tilt has no unit.
    return row % 2 == 0 ? RowLabel{wheel + " height", "m"} : RowLabel{wheel + " axle tilt", ""};
  }
};
LOCOGRAPH_REGISTER_EDGE(EdgeWheelContact::kTag, EdgeWheelContact)
extern template class TypedEdgePool<EdgeWheelContact>;

}  // namespace locograph
