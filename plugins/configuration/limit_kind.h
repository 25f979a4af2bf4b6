#pragma once
/// Limits as edges come in two kinds, which share everything but this.
///
///     e[0] = limit_error(LimitKind::kHinged, step_s - max_s);
///     if (limit_acts(LimitKind::kHinged, step_s - max_s)) j(0, 0) = step_s;
///
/// Hinged, g becomes max(0, g): an ordinary edge, zero and without derivative inside. Signed, g
/// stays: for Graph::set_constraint(e, ConstraintKind::kInequality), which then has a multiplier
/// (constraint.h). A signed edge that is not marked as a constraint pulls towards its limit.

namespace locograph {

enum class LimitKind { kHinged, kSigned };

inline double limit_error(LimitKind kind, double g) {
  return kind == LimitKind::kHinged && g < 0.0 ? 0.0 : g;
}
/// Whether the derivative of g is that of the error.
inline bool limit_acts(LimitKind kind, double g) { return kind == LimitKind::kSigned || g > 0.0; }
/// The derivative of |x|, 0 at its kink.
inline double sign(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }

}  // namespace locograph
