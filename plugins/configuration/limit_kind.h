#pragma once
/// Limits as edges come in two kinds, which share everything but this.
///
///     e[0] = limit_error(LimitKind::kHinged, step_s - max_s);
///     if (limit_acts(LimitKind::kHinged, step_s - max_s)) j(0, 0) = step_s;
///
/// Hinged, g becomes max(0, g): zero and without derivative inside, whoever looks at it. Signed, g
/// stays: the type says that it is an inequality, which then has a multiplier (constraint.h). A
/// signed edge that Graph::set_constraint() makes an ordinary one pulls towards its limit.

namespace locograph {

enum class LimitKind { kHinged, kSigned };

inline double limit_error(LimitKind kind, double g) {
  return kind == LimitKind::kHinged && g < 0.0 ? 0.0 : g;
}
/// Whether the derivative of g is that of the error.
inline bool limit_acts(LimitKind kind, double g) { return kind == LimitKind::kSigned || g > 0.0; }
/// How large a violation of a limit that is kept with a margin counts as none: what is left of the
/// margin then is for what edges do not see. Without a margin, rounding.
inline double margin_tolerance(double margin) {
  constexpr double kUsed = 0.9, kRounding = 1e-6;
  return margin > 0.0 ? kUsed * margin : kRounding;
}
/// The derivative of |x|, 0 at its kink.
inline double sign(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }

}  // namespace locograph
