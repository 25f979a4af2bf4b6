#pragma once
/// What edges about a robot's wheels share: the PARAMS_WHEELS they name, two rows for each wheel.
///
///     struct EdgeWheelContact : WheelsEdge<VertexConfiguration> {
///       void bind(const Parameters& parameters) { bind_wheels(parameters, kTag); }
///
/// Field of the edge's line: the number of the wheels.

#include <locograph/core/edge.h>
#include <locograph/plugins/configuration/edge_fit.h>

namespace locograph {

template <class... Vertices>
struct WheelsEdge : WeightedEdge<Eigen::Dynamic, Vertices...> {
  int wheels_number = 0;
  std::shared_ptr<const WheelsParameter> wheels;  ///< looked up by bind()
  std::shared_ptr<const RobotParameter> robot;    ///< whose wheels they are, likewise
  auto fields() { return std::tie(wheels_number); }

 protected:
  WheelsEdge() = default;
  WheelsEdge(const WheelsParameter& some, int number, double weight) : wheels_number(number) {
    this->weights.setConstant(2 * static_cast<Eigen::Index>(some.wheels.size()), weight);
  }

  /// Throws Error when they are not there, or their number does not fit the rows.
  void bind_wheels(const Parameters& parameters, std::string_view tag) {
    wheels = parameters.get<WheelsParameter>(wheels_number);
    robot = parameters.get<RobotParameter>(wheels->robot_number);
    require_rows(tag, this->dimension(), 2 * static_cast<long>(wheels->wheels.size()));
  }
};

}  // namespace locograph
