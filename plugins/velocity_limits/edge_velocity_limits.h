#pragma once
/// EDGE_VELOCITY_LIMITS: no joint, and not the base, moves faster than it may between two
/// configurations.
///
///     EDGE_VELOCITY_LIMITS id id  n fraction base_linear base_angular  weights
///
/// Error (active joints + 2): max(0, |Δq| − fraction · v_max · Δt) for each joint [rad or m], then
/// the same for the distance [m] and the angle [rad] the base moves. Zero inside the limits: a
/// limit, not a pull towards rest. Δt is the difference of the two time stamps. Limits of the base
/// in m/s and rad/s, 0 for none.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/row_labels.h>

namespace locograph {

struct EdgeVelocityLimits : WeightedEdge<Eigen::Dynamic, VertexConfiguration, VertexConfiguration> {
  static constexpr bool kOneSided = true;
  static constexpr std::string_view kTag = "EDGE_VELOCITY_LIMITS";
  double fraction = 1.0;
  double base_linear_m_s = 0.0;
  double base_angular_rad_s = 0.0;
  auto fields() { return std::tie(fraction, base_linear_m_s, base_angular_rad_s); }
  void bind(const Parameters& parameters) {
    require_fitting_robot(parameters, kTag, dimension(), [](const RobotParameter& p) {
      return p.robot->active_joint_count() + 2;
    });
  }

  EdgeVelocityLimits() = default;
  EdgeVelocityLimits(const Robot& robot, double fraction, double base_linear_m_s,
                     double base_angular_rad_s, double weight);

  void error(const ConfigurationState& a, const ConfigurationState& b,
             Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& a, const ConfigurationState& b,
                 JacobianRef<EdgeVelocityLimits, 0> ja,
                 JacobianRef<EdgeVelocityLimits, 1> jb) const;
  double row_tolerance(int row, const VertexConfiguration& a, const VertexConfiguration& b) const;
  RowLabel row_label(int row, const VertexConfiguration& a, const VertexConfiguration&) const {
    return motion_row(*a.robot->robot, row, "step");
  }
};
LOCOGRAPH_REGISTER_EDGE(EdgeVelocityLimits::kTag, EdgeVelocityLimits)
extern template class TypedEdgePool<EdgeVelocityLimits>;

}  // namespace locograph
