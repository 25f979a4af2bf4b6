#pragma once
/// A robust kernel: how much of an edge's squared error s = eᵀΩe counts as cost, ρ(s).
///
///     RobustKernel kernel = RobustKernel::parse("huber:1.5");
///     RobustKernel::Weights w = kernel.weights(9.0);   // w.cost = ρ(9), w.weight = ρ'(9)
///
/// All kernels satisfy ρ(0) = 0 and ρ'(0) = 1, so that a small error costs what it would without a
/// kernel; `width` is the error (not its square) at which the kernel begins to bite. Formulae:
/// Barron 2019 (general loss), Agarwal et al. 2013 (DCS), Black & Rangarajan 1996 (the others).

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
  };

  Kind kind = Kind::kNone;
  double width = 1.0;

  struct Weights {
    double cost;    ///< ρ(s)
    double weight;  ///< ρ'(s), in [0, 1]: the factor on the edge's information
  };
  /// s: squared error, ≥ 0.
  Weights weights(double s) const {
    if (kind == Kind::kNone) return {s, 1.0};
    return robust_weights(s);
  }

  std::string name() const;
  /// "NAME" or "NAME:WIDTH" with WIDTH > 0. Throws Error naming the kernels there are.
  static RobustKernel parse(std::string_view text);
  static std::vector<std::string> names();

  bool operator==(const RobustKernel&) const = default;

 private:
  Weights robust_weights(double s) const;

 public:
  RobustKernel() = default;
  RobustKernel(Kind k, double w) : kind(k), width(w) {}
};

}  // namespace locograph
