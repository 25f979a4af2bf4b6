#pragma once
/// What makes an edge a constraint, and how its error enters the cost of an augmented Lagrangian.
///
///     EdgeId e = graph.add_edge(on_circle, point);
///     graph.set_constraint(e, ConstraintKind::kEquality);        // error = 0
///     graph.set_constraint(f, ConstraintKind::kInequality);      // every row of the error ≤ 0
///
/// The rows c of a constraint edge are charged as ‖scale·(c + shift)‖² under the edge's Ω, those of
/// an inequality as ‖max(0, scale·(c + shift))‖²; augmented_lagrangian.h moves shift and scale from
/// round to round. With scale² = μ this is, up to a constant, 2μ shiftᵀΩ c + μ cᵀΩc: the multiplier
/// of the Lagrangian Σ eᵀΩe + λᵀc is λ = 2μ Ω shift (Nocedal & Wright 2006, eq. 17.36 and 17.65).
/// Robust kernels do not apply to constraints.
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
  bool one_sided = false;
};

/// e ← scale·(e + shift) of n rows, hinged where the row is one-sided.
void constrain_error(const ConstraintRow* rows, int n, double* e);

/// The same for the derivative (n × d), stored row by row or column by column; `e` is the error
/// after constrain_error().
void constrain_jacobian(const ConstraintRow* rows, int n, int d, const double* e, double* jacobian,
                        bool by_row);

}  // namespace locograph
