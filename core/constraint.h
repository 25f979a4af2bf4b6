#pragma once
/// What makes an edge a constraint, and how its error enters the cost of an augmented Lagrangian.
///
///     struct EdgeOnCircle : Edge<1, VertexXY> {
///       static constexpr ConstraintKind kConstraint = ConstraintKind::kEquality;   // error = 0
///       static constexpr double kTolerance = 1e-4;                                 // see edge.h
///     };
///
/// A trait of its type, then; types that hinge by themselves (kOneSided) are inequalities without
/// saying so. For a single edge the graph may say otherwise, and files keep what it says:
///
///     graph.set_constraint(e, ConstraintKind::kInequality);      // every row of the error ≤ 0
///
/// The rows c of a constraint edge are charged as ‖scale·(c + shift)‖² under the edge's Ω, those of
/// an inequality as ‖max(0, scale·(c + shift))‖²; as an ordinary edge while shift is 0 and
/// scale 1, as in optimise(); augmented_lagrangian.h moves them from round to round. With scale² =
/// μ this is, up to a constant, 2μ shiftᵀΩ c + μ cᵀΩc: the multiplier of the Lagrangian Σ eᵀΩe +
/// λᵀc is λ = 2μ Ω shift (Nocedal & Wright 2006, eq. 17.36 and 17.65). Robust kernels do not apply
/// to constraints.
///
/// An inequality needs the signed value: the error of its type is g(x), negative inside. Types that
/// hinge by themselves (kOneSided) do not tell how far inside they are; they may be constraints of
/// either kind, but have no multiplier: only their weight is raised.

namespace locograph {

enum class ConstraintKind : unsigned char {
  kNone,        ///< an ordinary edge
  kEquality,    ///< error = 0
  kInequality,  ///< every row of the error ≤ 0; Ω must be diagonal
};

/// The state of one row of a constraint edge.
struct ConstraintRow {
  double shift = 0.0;  ///< in the unit of the error
  double scale = 1.0;  ///< square root of the penalty

  bool operator==(const ConstraintRow&) const = default;
};

/// e ← scale·(e + shift) of n rows, hinged if they are one-sided.
void constrain_error(const ConstraintRow* rows, bool one_sided, int n, double* e);

/// The same for the derivative (n × d), stored row by row or column by column; `e` is the error
/// after constrain_error(). Rows inside their limit become zero, unless the type hinges by itself:
/// then they are left as they are, for nobody reads them.
void constrain_jacobian(const ConstraintRow* rows, bool one_sided, int n, int d, const double* e,
                        double* jacobian, bool by_row, bool hinged = false);

}  // namespace locograph
