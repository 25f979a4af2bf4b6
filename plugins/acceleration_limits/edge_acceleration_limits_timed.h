#pragma once
/// EDGE_ACCELERATION_LIMITS_TIMED and EDGE_REST_ACCELERATION_LIMITS_TIMED: the limits of
/// EDGE_ACCELERATION_LIMITS where the times between configurations are unknowns.
///
///     EDGE_ACCELERATION_LIMITS_TIMED id id id step step  n limits…  weights
///     EDGE_REST_ACCELERATION_LIMITS_TIMED id id step  n limits…  weights
///
/// Both also with _SIGNED behind their tag (limit_kind.h).
///
/// Error (active joints + 2): the rows of acceleration_rows.h, |a| − limit, with Δt₁ and Δt₂ the
/// two VERTEX_TIME_STEPs. The second edge is for the ends of a motion, where one of its two
/// configurations, either of them, is at rest: what moves over Δt at constant acceleration moves
/// ½ a Δt², so a = 2 Δq / Δt². Time stamps are not read.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/acceleration_limits/acceleration_rows.h>
#include <locograph/plugins/configuration/row_labels.h>
#include <locograph/plugins/time_step/vertex_time_step.h>

namespace locograph {

/// What the two share: their limits, active joints first, then linear and angular of the base.
template <class... Vertices>
struct AccelerationLimitedEdge : WeightedEdge<Eigen::Dynamic, Vertices...> {
  Eigen::VectorXd limits;  ///< one for each row, ≥ 0
  auto fields() { return std::tie(limits); }
  double row_tolerance(int row) const { return AccelerationRows::tolerance(limits[row]); }
  void resize(int n) {
    this->weights.resize(n);
    limits.resize(n);
  }

 protected:
  AccelerationLimitedEdge() = default;
  AccelerationLimitedEdge(const Eigen::VectorXd& some, double weight) : limits(some) {
    this->weights.setConstant(some.size(), weight);
  }
};

template <LimitKind kKind>
struct AccelerationLimitsTimed
    : AccelerationLimitedEdge<VertexConfiguration, VertexConfiguration, VertexConfiguration,
                              VertexTimeStep, VertexTimeStep> {
  static constexpr bool kOneSided = kKind == LimitKind::kHinged;
  static constexpr ConstraintKind kConstraint = ConstraintKind::kInequality;
  static constexpr std::string_view kTag =
      kOneSided ? "EDGE_ACCELERATION_LIMITS_TIMED" : "EDGE_ACCELERATION_LIMITS_TIMED_SIGNED";
  void bind(const Parameters& parameters) const {
    AccelerationRows::check(kTag, limits, dimension(), parameters);
  }

  AccelerationLimitsTimed() = default;
  AccelerationLimitsTimed(const Eigen::VectorXd& some, double weight)
      : AccelerationLimitedEdge(some, weight) {}

  void error(const ConfigurationState& a, const ConfigurationState& b, const ConfigurationState& c,
             double step_1_s, double step_2_s, Eigen::Ref<Eigen::VectorXd> e) const {
    rows(a, b, c, step_1_s, step_2_s).error(kKind, e);
  }
  void jacobians(const ConfigurationState& a, const ConfigurationState& b,
                 const ConfigurationState& c, double step_1_s, double step_2_s,
                 JacobianRef<AccelerationLimitsTimed, 0> ja,
                 JacobianRef<AccelerationLimitsTimed, 1> jb,
                 JacobianRef<AccelerationLimitsTimed, 2> jc,
                 JacobianRef<AccelerationLimitsTimed, 3> by_step_1,
                 JacobianRef<AccelerationLimitsTimed, 4> by_step_2) const {
    const AccelerationRows limited = rows(a, b, c, step_1_s, step_2_s);
    limited.by_configurations(kKind, &ja, jb, jc);
    limited.by_log_steps(kKind, &by_step_1, by_step_2);
  }
  RowLabel row_label(int row, const VertexConfiguration& a, const VertexConfiguration&,
                     const VertexConfiguration&, const VertexTimeStep&,
                     const VertexTimeStep&) const {
    return motion_row(*a.robot->robot, row, "acceleration", "/s^2");
  }

 private:
  AccelerationRows rows(const ConfigurationState& a, const ConfigurationState& b,
                        const ConfigurationState& c, double step_1_s, double step_2_s) const {
    return {kTag, limits, {a, b, c, {step_1_s, step_2_s}}};
  }
};

template <LimitKind kKind>
struct RestAccelerationLimitsTimed
    : AccelerationLimitedEdge<VertexConfiguration, VertexConfiguration, VertexTimeStep> {
  static constexpr bool kOneSided = kKind == LimitKind::kHinged;
  static constexpr ConstraintKind kConstraint = ConstraintKind::kInequality;
  static constexpr std::string_view kTag = kOneSided ? "EDGE_REST_ACCELERATION_LIMITS_TIMED"
                                                     : "EDGE_REST_ACCELERATION_LIMITS_TIMED_SIGNED";
  void bind(const Parameters& parameters) const {
    AccelerationRows::check(kTag, limits, dimension(), parameters);
  }

  RestAccelerationLimitsTimed() = default;
  RestAccelerationLimitsTimed(const Eigen::VectorXd& some, double weight)
      : AccelerationLimitedEdge(some, weight) {}

  void error(const ConfigurationState& a, const ConfigurationState& b, double step_s,
             Eigen::Ref<Eigen::VectorXd> e) const {
    rows(a, b, step_s).error(kKind, e);
  }
  void jacobians(const ConfigurationState& a, const ConfigurationState& b, double step_s,
                 JacobianRef<RestAccelerationLimitsTimed, 0> ja,
                 JacobianRef<RestAccelerationLimitsTimed, 1> jb,
                 JacobianRef<RestAccelerationLimitsTimed, 2> by_step) const {
    const AccelerationRows limited = rows(a, b, step_s);
    limited.by_configurations(kKind, nullptr, ja, jb);
    limited.by_log_steps(kKind, nullptr, by_step);
  }
  RowLabel row_label(int row, const VertexConfiguration& a, const VertexConfiguration&,
                     const VertexTimeStep&) const {
    return motion_row(*a.robot->robot, row, "acceleration", "/s^2");
  }

 private:
  AccelerationRows rows(const ConfigurationState& a, const ConfigurationState& b,
                        double step_s) const {
    return {kTag, limits, {a, a, b, SecondDifference::from_rest(step_s)}};
  }
};

using EdgeAccelerationLimitsTimed = AccelerationLimitsTimed<LimitKind::kHinged>;
using EdgeAccelerationLimitsTimedSigned = AccelerationLimitsTimed<LimitKind::kSigned>;
using EdgeRestAccelerationLimitsTimed = RestAccelerationLimitsTimed<LimitKind::kHinged>;
using EdgeRestAccelerationLimitsTimedSigned = RestAccelerationLimitsTimed<LimitKind::kSigned>;
LOCOGRAPH_REGISTER_EDGE(EdgeAccelerationLimitsTimed::kTag, EdgeAccelerationLimitsTimed)
LOCOGRAPH_REGISTER_EDGE(EdgeAccelerationLimitsTimedSigned::kTag, EdgeAccelerationLimitsTimedSigned)
LOCOGRAPH_REGISTER_EDGE(EdgeRestAccelerationLimitsTimed::kTag, EdgeRestAccelerationLimitsTimed)
LOCOGRAPH_REGISTER_EDGE(EdgeRestAccelerationLimitsTimedSigned::kTag,
                        EdgeRestAccelerationLimitsTimedSigned)
extern template class TypedEdgePool<EdgeAccelerationLimitsTimed>;
extern template class TypedEdgePool<EdgeAccelerationLimitsTimedSigned>;
extern template class TypedEdgePool<EdgeRestAccelerationLimitsTimed>;
extern template class TypedEdgePool<EdgeRestAccelerationLimitsTimedSigned>;

}  // namespace locograph
