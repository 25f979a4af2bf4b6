#pragma once
/// EDGE_VELOCITY_LIMITS_TIMED: the limits of EDGE_VELOCITY_LIMITS where the time between two
/// configurations is an unknown.
///
///     EDGE_VELOCITY_LIMITS_TIMED id id step  n fraction base_linear base_angular  weights
///     EDGE_VELOCITY_LIMITS_TIMED_SIGNED id id step  n fraction base_linear base_angular  weights
///
/// Error (active joints + 2): the rows of velocity_rows.h, |Δq| − rate · Δt with Δt the
/// VERTEX_TIME_STEP; hinged, or signed (limit_kind.h). Time stamps are not read.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/row_labels.h>
#include <locograph/plugins/time_step/vertex_time_step.h>
#include <locograph/plugins/velocity_limits/velocity_rows.h>

namespace locograph {

template <LimitKind kKind>
struct VelocityLimitsTimed
    : WeightedEdge<Eigen::Dynamic, VertexConfiguration, VertexConfiguration, VertexTimeStep> {
  static constexpr bool kOneSided = kKind == LimitKind::kHinged;
  static constexpr ConstraintKind kConstraint = ConstraintKind::kInequality;
  static constexpr std::string_view kTag =
      kOneSided ? "EDGE_VELOCITY_LIMITS_TIMED" : "EDGE_VELOCITY_LIMITS_TIMED_SIGNED";
  VelocityRows limits;
  auto fields() {
    return std::tie(limits.fraction, limits.base_linear_m_s, limits.base_angular_rad_s);
  }
  void bind(const Parameters& parameters) const {
    require_fitting_robot(parameters, kTag, dimension(),
                          [](const RobotParameter& p) { return VelocityRows::count(*p.robot); });
  }

  VelocityLimitsTimed() = default;
  VelocityLimitsTimed(const Robot& robot, double fraction, double base_linear_m_s,
                      double base_angular_rad_s, double weight)
      : limits{fraction, base_linear_m_s, base_angular_rad_s} {
    weights.setConstant(VelocityRows::count(robot), weight);
  }

  void error(const ConfigurationState& a, const ConfigurationState& b, double step_s,
             Eigen::Ref<Eigen::VectorXd> e) const {
    limits.error(kTag, kKind, a, b, step_s, e);
  }
  void jacobians(const ConfigurationState& a, const ConfigurationState& b, double step_s,
                 JacobianRef<VelocityLimitsTimed, 0> ja, JacobianRef<VelocityLimitsTimed, 1> jb,
                 JacobianRef<VelocityLimitsTimed, 2> by_step) const {
    limits.jacobians(kKind, a, b, step_s, ja, jb, &by_step);
    by_step *= step_s;  // d Δt = Δt d(log Δt)
  }
  double row_tolerance(int row, const VertexConfiguration& a, const VertexConfiguration&,
                       const VertexTimeStep& step) const {
    return limits.tolerance(*a.robot->robot, row, step.seconds());
  }
  RowLabel row_label(int row, const VertexConfiguration& a, const VertexConfiguration&,
                     const VertexTimeStep&) const {
    return motion_row(*a.robot->robot, row, "step");
  }
};

using EdgeVelocityLimitsTimed = VelocityLimitsTimed<LimitKind::kHinged>;
using EdgeVelocityLimitsTimedSigned = VelocityLimitsTimed<LimitKind::kSigned>;
LOCOGRAPH_REGISTER_EDGE(EdgeVelocityLimitsTimed::kTag, EdgeVelocityLimitsTimed)
LOCOGRAPH_REGISTER_EDGE(EdgeVelocityLimitsTimedSigned::kTag, EdgeVelocityLimitsTimedSigned)
extern template class TypedEdgePool<EdgeVelocityLimitsTimed>;
extern template class TypedEdgePool<EdgeVelocityLimitsTimedSigned>;

}  // namespace locograph
