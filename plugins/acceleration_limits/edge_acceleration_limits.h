#pragma once
/// EDGE_ACCELERATION_LIMITS: no joint, and not the base, accelerates more than it may over three
/// consecutive configurations.
///
///     EDGE_ACCELERATION_LIMITS id id id  n limits…  weights
///
///     graph.add_edge(EdgeAccelerationLimits(robot, 20.0, 5.0, 10.0, 1.0), before, here, after);
///
/// Error (active joints + 2): max(0, |a| − limit) for each joint [rad/s² or m/s²], then the same
/// for the linear [m/s²] and the angular [rad/s²] acceleration of the base. Zero inside the limits.
/// A limit of 0 stands for none. URDF has no limits of acceleration: they are the edge's.
///
/// The steps in time, Δt₁ and Δt₂, need not be equal: a = 2 (v₂ − v₁) / (Δt₁ + Δt₂) with v = Δq/Δt
/// is the second derivative of the parabola through three samples. The base's v are its
/// displacement in the world, and its rotation vector from one configuration to the next in the
/// base frame of the middle one, each by its Δt. Throws Error where the times do not increase.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/acceleration_limits/acceleration_rows.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/row_labels.h>

namespace locograph {

struct EdgeAccelerationLimits
    : WeightedEdge<Eigen::Dynamic, VertexConfiguration, VertexConfiguration, VertexConfiguration> {
  static constexpr bool kOneSided = true;
  static constexpr std::string_view kTag = "EDGE_ACCELERATION_LIMITS";
  Eigen::VectorXd limits;  ///< one for each row, ≥ 0
  auto fields() { return std::tie(limits); }
  void resize(int n) {
    weights.resize(n);
    limits.resize(n);
  }
  void bind(const Parameters& parameters) const;

  EdgeAccelerationLimits() = default;
  /// limits: active joints, then linear and angular of the base.
  EdgeAccelerationLimits(const Eigen::VectorXd& limits, double weight);
  /// One limit for all joints, in the unit of each.
  EdgeAccelerationLimits(const Robot& robot, double joint, double base_linear_m_s2,
                         double base_angular_rad_s2, double weight);

  void error(const ConfigurationState& a, const ConfigurationState& b, const ConfigurationState& c,
             Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& a, const ConfigurationState& b,
                 const ConfigurationState& c, JacobianRef<EdgeAccelerationLimits, 0> ja,
                 JacobianRef<EdgeAccelerationLimits, 1> jb,
                 JacobianRef<EdgeAccelerationLimits, 2> jc) const;
  double row_tolerance(int row) const { return AccelerationRows::tolerance(limits[row]); }
  RowLabel row_label(int row, const VertexConfiguration& a, const VertexConfiguration&,
                     const VertexConfiguration&) const {
    return motion_row(*a.robot->robot, row, "acceleration", "/s^2");
  }
};
LOCOGRAPH_REGISTER_EDGE(EdgeAccelerationLimits::kTag, EdgeAccelerationLimits)
extern template class TypedEdgePool<EdgeAccelerationLimits>;

}  // namespace locograph
