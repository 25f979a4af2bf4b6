#pragma once
/// EDGE_TIME_STEP_LIMITS: a time step that is neither too short nor too long.
///
///     EDGE_TIME_STEP_LIMITS id  min max  weights                        (s)
///     EDGE_TIME_STEP_LIMITS_SIGNED id  min max  weights
///
/// Error (2) [s]: max(0, min − Δt), max(0, Δt − max); without the hinge when signed (limit_kind.h).
/// 0 ≤ min ≤ max, or it is an Error. The vertex keeps Δt positive by itself: min is for what a
/// controller can follow, max for how coarse the plan may become.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/limit_kind.h>
#include <locograph/plugins/time_step/vertex_time_step.h>

namespace locograph {

template <LimitKind kKind>
struct TimeStepLimits : WeightedEdge<2, VertexTimeStep> {
  static constexpr bool kOneSided = kKind == LimitKind::kHinged;
  static constexpr ConstraintKind kConstraint = ConstraintKind::kInequality;
  static constexpr double kTolerance = 1e-6;  ///< s
  static constexpr std::string_view kTag =
      kOneSided ? "EDGE_TIME_STEP_LIMITS" : "EDGE_TIME_STEP_LIMITS_SIGNED";
  double min_s = 0.0;
  double max_s = 0.0;
  auto fields() { return std::tie(min_s, max_s); }
  void bind(const Parameters&) const {
    if (min_s >= 0.0 && min_s <= max_s) return;
    throw locograph::Error(std::string(kTag) + " from " + std::to_string(min_s) + " to " +
                               std::to_string(max_s) + " s",
                           "0 <= min <= max");
  }

  TimeStepLimits() = default;
  TimeStepLimits(double min, double max, double weight) : min_s(min), max_s(max) {
    weights.setConstant(weight);
  }

  void error(double step_s, Eigen::Ref<Eigen::Vector2d> e) const {
    e[0] = limit_error(kKind, min_s - step_s);
    e[1] = limit_error(kKind, step_s - max_s);
  }
  void jacobians(double step_s, JacobianRef<TimeStepLimits, 0> j) const {
    if (limit_acts(kKind, min_s - step_s)) j(0, 0) = -step_s;
    if (limit_acts(kKind, step_s - max_s)) j(1, 0) = step_s;
  }
  RowLabel row_label(int row) const {
    return {row == 0 ? "time step below its minimum" : "time step above its maximum", "s"};
  }
};

using EdgeTimeStepLimits = TimeStepLimits<LimitKind::kHinged>;
using EdgeTimeStepLimitsSigned = TimeStepLimits<LimitKind::kSigned>;
LOCOGRAPH_REGISTER_EDGE(EdgeTimeStepLimits::kTag, EdgeTimeStepLimits)
LOCOGRAPH_REGISTER_EDGE(EdgeTimeStepLimitsSigned::kTag, EdgeTimeStepLimitsSigned)
extern template class TypedEdgePool<EdgeTimeStepLimits>;
extern template class TypedEdgePool<EdgeTimeStepLimitsSigned>;

}  // namespace locograph
