#include <locograph/common/error.h>
#include <locograph/common/suggestion.h>
#include <locograph/core/robust_kernel.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace locograph {
namespace {

constexpr std::string_view kNames[] = {"none",          "huber",  "pseudo-huber", "cauchy",
                                       "geman-mcclure", "welsch", "fair",         "tukey",
                                       "saturated",     "dcs",    "arctan",       "barron"};
constexpr std::string_view kSecondOrder = "second-order";

using Weights = RobustKernel::Weights;

/// Barron 2019, eq. 8, in the form ρ = 2c² (b/α) ((1 + u/b)^(α/2) − 1) with b = 2 − α, through
/// expm1 and log1p so that the limits α → 0 and α → −∞ are approached without cancellation.
Weights barron(double s, double c2, double alpha) {
  const double u = s / c2;
  const double b = 2.0 - alpha;
  if (b < 1e-9) return {s, 1.0, 0.0};
  if (!(b < 1e15)) {
    const double e = std::exp(-0.5 * u);
    return {-2.0 * c2 * std::expm1(-0.5 * u), e, -0.5 * e / c2};
  }
  // log(1 + u/b), also where u/b is beyond the range of numbers.
  const double l = u < 1e290 ? std::log1p(u / b) : std::log(u) - std::log(b);
  const double half = 0.5 * alpha, exponent = half * l;
  double growth;  // b ((1 + u/b)^(α/2) − 1) / α
  if (std::abs(alpha) < 1e-15) {
    growth = 0.5 * b * l;
  } else if (exponent > 600.0) {
    growth = std::exp(exponent + std::log(b)) / alpha;
  } else {
    growth = b * std::expm1(exponent) / alpha;
  }
  return {2.0 * c2 * growth, std::exp((half - 1.0) * l), -0.5 / c2 * std::exp((half - 2.0) * l)};
}

/// Truncated least squares, graduated: Yang et al. 2020, eq. 13 and 14; μ = ∞ is the kernel itself.
Weights saturated(double s, double c2, double mu) {
  if (std::isinf(mu)) {
    if (s > c2) return {c2, 0.0, 0.0};
    return {s, 1.0, 0.0};
  }
  if (s <= mu / (mu + 1.0) * c2) return {s, 1.0, 0.0};
  if (s >= (mu + 1.0) / mu * c2) return {c2, 0.0, 0.0};
  const double factor = std::sqrt(mu * (mu + 1.0) * c2), root = std::sqrt(s);
  return {2.0 * factor * root - mu * (c2 + s), factor / root - mu, -0.5 * factor / (root * s)};
}

double parse_number(std::string_view text, const char* what) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end || std::isnan(value)) {
    throw Error(std::string(what) + " '" + std::string(text) + "'", "a number");
  }
  return value;
}

}  // namespace

RobustKernel::Weights RobustKernel::robust_weights(double s) const {
  const double c2 = width * width;
  const double u = s / c2;
  switch (kind) {
    case Kind::kNone:
      return {s, 1.0};
    case Kind::kHuber: {
      if (s <= c2) return {s, 1.0};
      const double root = std::sqrt(s);
      return {2.0 * width * root - c2, width / root, -0.5 * width / (root * s)};
    }
    case Kind::kPseudoHuber: {
      const double root = std::sqrt(1.0 + u);
      return {2.0 * c2 * (root - 1.0), 1.0 / root, -0.5 / (c2 * root * (1.0 + u))};
    }
    case Kind::kCauchy: {
      const double w = 1.0 / (1.0 + u);
      return {c2 * std::log1p(u), w, -w * w / c2};
    }
    case Kind::kGemanMcClure: {
      const double w = 1.0 / (1.0 + u);
      return {s * w, w * w, -2.0 * w * w * w / c2};
    }
    case Kind::kWelsch: {
      const double w = std::exp(-u);
      return {-c2 * std::expm1(-u), w, -w / c2};
    }
    case Kind::kFair: {
      const double a = std::sqrt(u), w = 1.0 / (1.0 + a);
      // ρ'' grows without bound towards zero; what is used of it, s ρ'', vanishes there.
      return {2.0 * c2 * (a - std::log1p(a)), w, -0.5 * w * w / (c2 * std::max(a, 1e-100))};
    }
    case Kind::kTukey: {
      if (s > c2) return {c2 / 3.0, 0.0};
      const double v = 1.0 - u;
      return {c2 / 3.0 * (1.0 - v * v * v), v * v, -2.0 * v / c2};
    }
    case Kind::kSaturated:
      return saturated(s, c2, shape);
    case Kind::kDcs: {
      // Φ = c²; the switch variable of the closed form is min(1, 2Φ / (Φ + s)).
      if (s <= c2) return {s, 1.0};
      const double w = 2.0 * c2 / (c2 + s);
      return {c2 * (3.0 * s - c2) / (c2 + s), w * w, -w * w * w / c2};
    }
    case Kind::kArctan: {
      const double w = 1.0 / (1.0 + u * u);
      return {c2 * std::atan(u), w, -2.0 * w * (u * w) / c2};
    }
    case Kind::kBarron:
      return barron(s, c2, shape);
  }
  return {s, 1.0};
}

std::string RobustKernel::name() const { return std::string(kNames[static_cast<int>(kind)]); }

std::vector<std::string> RobustKernel::names() {
  return std::vector<std::string>(std::begin(kNames), std::end(kNames));
}

RobustKernel RobustKernel::parse(std::string_view text) {
  std::vector<std::string_view> fields;
  for (std::string_view rest = text;; rest.remove_prefix(fields.back().size() + 1)) {
    fields.push_back(rest.substr(0, rest.find(':')));
    if (fields.back().size() == rest.size()) break;
  }
  const auto* const found = std::find(std::begin(kNames), std::end(kNames), fields[0]);
  if (found == std::end(kNames)) {
    throw Error("unknown robust kernel '" + std::string(fields[0]) + "'",
                "one of " + joined_names(names()) + did_you_mean(fields[0], names()));
  }
  RobustKernel kernel(static_cast<Kind>(found - std::begin(kNames)), 1.0);
  if (fields.size() > 1 && fields.back() == kSecondOrder) {
    kernel.second_order = true;
    fields.pop_back();
  }
  if (fields.size() > 1) {
    kernel.width = parse_number(fields[1], "kernel width");
    if (!(kernel.width > 0.0) || std::isinf(kernel.width)) {
      throw Error("kernel width '" + std::string(fields[1]) + "'", "a number > 0");
    }
  }
  if (fields.size() > 2 && kernel.kind == Kind::kBarron) {
    kernel.shape = parse_number(fields[2], "kernel shape");
    if (kernel.shape > 2.0) {
      throw Error("kernel shape '" + std::string(fields[2]) + "'", "a number <= 2, or -inf");
    }
  }
  if (fields.size() > (kernel.kind == Kind::kBarron ? 3u : 2u)) {
    throw Error("robust kernel '" + std::string(text) + "' has too many fields",
                "NAME[:WIDTH][:second-order], or barron[:WIDTH[:ALPHA]][:second-order]");
  }
  return kernel;
}

}  // namespace locograph
