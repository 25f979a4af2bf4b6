#pragma once
/// A robust kernel: how much of an edge's squared error s = eᵀΩe counts as cost, ρ(s).
///
///     RobustKernel kernel = RobustKernel::parse("huber:1.5");
///     RobustKernel::Weights w = kernel.weights(9.0);   // w.cost = ρ(9), w.weight = ρ'(9)
///
/// All kernels satisfy ρ(0) = 0 and ρ'(0) = 1, so that a small error costs what it would without a
/// kernel; `width` is the error (not its square) at which the kernel begins to bite. Formulae:
/// Barron 2019 ("A general and adaptive robust loss function", eq. 8–13, times 2·width² so that
/// ρ'(0) = 1), Agarwal et al. 2013 (DCS), Yang et al. 2020 (the graduated saturated kernel),
/// Black & Rangarajan 1996 (the others).
///
/// The optimiser weights an edge by ρ'(s) and leaves its curvature out (iteratively reweighted
/// least squares). With `second_order` it also takes ρ''(s) into account (Triggs et al. 1999,
/// section 4.3), which makes H that of the robust cost: quadratic instead of linear convergence
/// where many errors lie on the shoulder of the kernel, at the price of a little work for each edge
/// and of shorter steps where outliers still have to be pulled in. Off by default for that reason.

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace locograph {

struct RobustKernel {
  enum class Kind : unsigned char {
    kNone,
    kHuber,
    kPseudoHuber,
    kCauchy,
    kGemanMcClure,
    kWelsch,
    kFair,
    kTukey,
    kSaturated,
    kDcs,
    kArctan,
    kBarron,
  };

  Kind kind = Kind::kNone;
  /// Weight by the curvature of ρ as well. Edges with a diagonal Ω do not use it.
  bool second_order = false;
  double width = 1.0;
  /// Barron's α ≤ 2 (2: none, 1: pseudo-Huber, 0: Cauchy, −2: Geman-McClure, −∞: Welsch, each with
  /// its own width); of the saturated kernel the control parameter μ > 0 that makes it convex
  /// towards 0 and is infinite for the kernel itself. Others have none.
  double shape = std::numeric_limits<double>::infinity();

  struct Weights {
    double cost;             ///< ρ(s)
    double weight;           ///< ρ'(s), in [0, 1]: the factor on the edge's information
    double curvature = 0.0;  ///< ρ''(s), ≤ 0; at a kink that of the left side
  };
  /// s: squared error, ≥ 0.
  Weights weights(double s) const {
    if (kind == Kind::kNone) return {s, 1.0};
    return robust_weights(s);
  }
  /// β such that ρ'(Ω + β Ωe(Ωe)ᵀ) is the information to linearise with: 2ρ''/ρ', but never less
  /// than −1/s, which keeps it positive semi-definite. Zero without `second_order`.
  double correction(double s, const Weights& w) const {
    if (!second_order || s <= 0.0 || w.weight <= 0.0) return 0.0;
    const double beta = 2.0 * w.curvature / w.weight;
    return beta * s > -1.0 ? beta : -1.0 / s;
  }

  std::string name() const;
  /// NAME[:WIDTH], barron[:WIDTH[:ALPHA]], WIDTH > 0, each with :second-order behind it if wanted.
  /// The width is 1 unless given, α is 1. Throws Error naming the kernels there are.
  static RobustKernel parse(std::string_view text);
  static std::vector<std::string> names();

  bool operator==(const RobustKernel&) const = default;

 private:
  Weights robust_weights(double s) const;

 public:
  RobustKernel() = default;
  RobustKernel(Kind k, double w)
      : kind(k),
        width(w),
        shape(k == Kind::kBarron ? 1.0 : std::numeric_limits<double>::infinity()) {}
  RobustKernel(Kind k, double w, double s) : kind(k), width(w), shape(s) {}
};

}  // namespace locograph
