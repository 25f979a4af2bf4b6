#include <locograph/common/error.h>
#include <locograph/core/robust_kernel.h>

#include <charconv>
#include <cmath>

namespace locograph {
namespace {

constexpr std::string_view kNames[] = {"none",          "huber",  "pseudo-huber", "cauchy",
                                       "geman-mcclure", "welsch", "fair",         "tukey",
                                       "saturated",     "dcs",    "arctan"};

}  // namespace

RobustKernel::Weights RobustKernel::robust_weights(double s) const {
  const double c2 = width * width;
  const double u = s / c2;
  switch (kind) {
    case Kind::kNone:
      return {s, 1.0};
    case Kind::kHuber:
      if (s <= c2) return {s, 1.0};
      return {2.0 * width * std::sqrt(s) - c2, width / std::sqrt(s)};
    case Kind::kPseudoHuber: {
      const double root = std::sqrt(1.0 + u);
      return {2.0 * c2 * (root - 1.0), 1.0 / root};
    }
    case Kind::kCauchy:
      return {c2 * std::log1p(u), 1.0 / (1.0 + u)};
    case Kind::kGemanMcClure:
      return {s / (1.0 + u), 1.0 / ((1.0 + u) * (1.0 + u))};
    case Kind::kWelsch:
      return {-c2 * std::expm1(-u), std::exp(-u)};
    case Kind::kFair: {
      const double a = std::sqrt(u);
      return {2.0 * c2 * (a - std::log1p(a)), 1.0 / (1.0 + a)};
    }
    case Kind::kTukey: {
      if (s > c2) return {c2 / 3.0, 0.0};
      const double v = 1.0 - u;
      return {c2 / 3.0 * (1.0 - v * v * v), v * v};
    }
    case Kind::kSaturated:
      if (s > c2) return {c2, 0.0};
      return {s, 1.0};
    case Kind::kDcs: {
      // Φ = c²; the switch variable of the closed form is min(1, 2Φ / (Φ + s)).
      if (s <= c2) return {s, 1.0};
      const double w = 2.0 * c2 / (c2 + s);
      return {c2 * (3.0 * s - c2) / (c2 + s), w * w};
    }
    case Kind::kArctan:
      return {c2 * std::atan(u), 1.0 / (1.0 + u * u)};
  }
  return {s, 1.0};
}

std::string RobustKernel::name() const { return std::string(kNames[static_cast<int>(kind)]); }

std::vector<std::string> RobustKernel::names() {
  return std::vector<std::string>(std::begin(kNames), std::end(kNames));
}

RobustKernel RobustKernel::parse(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::string_view name = text.substr(0, colon);
  RobustKernel kernel;
  bool found = false;
  for (std::size_t i = 0; i < std::size(kNames); ++i) {
    if (kNames[i] == name) {
      kernel.kind = static_cast<Kind>(i);
      found = true;
    }
  }
  if (!found) {
    std::string all;
    for (const std::string_view known : kNames)
      all += (all.empty() ? "" : ", ") + std::string(known);
    throw Error("unknown robust kernel '" + std::string(name) + "'", "one of " + all);
  }
  if (colon != std::string_view::npos) {
    const std::string_view number = text.substr(colon + 1);
    const char* end = number.data() + number.size();
    const std::from_chars_result result = std::from_chars(number.data(), end, kernel.width);
    if (result.ec != std::errc() || result.ptr != end || !(kernel.width > 0.0) ||
        !std::isfinite(kernel.width)) {
      throw Error("kernel width '" + std::string(number) + "'", "a number > 0");
    }
  }
  return kernel;
}

}  // namespace locograph
