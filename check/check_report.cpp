#include <locograph/check/check_report.h>
#include <locograph/common/check_option.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace locograph {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// By how much it is violated; how much of a unit counts as one.
double excess(const Violation& v) {
  const double scale = v.unit == "m" ? 0.01 : v.unit == "count" ? 1e-3 : 0.1;
  const double amount = std::abs(v.worst - v.limit) / scale;
  return std::isnan(amount) ? HUGE_VAL : amount;
}

}  // namespace

void CheckOptions::validate() const {
  const auto positive = [](double value, const char* name) {
    check_option(value > 0.0 && std::isfinite(value), name, "a positive number");
  };
  const auto not_negative = [](double value, const char* name) {
    check_option(value >= 0.0 && std::isfinite(value), name, "a number that is not negative");
  };
  const auto limit = [](double value, const char* name) {
    check_option(value >= 0.0, name, "a limit, or 0 for none");
  };
  limit(base_linear_m_s, "base_linear_m_s");
  limit(base_angular_rad_s, "base_angular_rad_s");
  limit(joint_acceleration_rad_s2, "joint_acceleration_rad_s2");
  positive(effort_scale, "effort_scale");
  if (until_s)
    check_option(std::isfinite(*until_s) && *until_s >= 0.0, "until_s", "a time, 0 or later");
  not_negative(min_clearance_m, "min_clearance_m");
  not_negative(min_self_clearance_m, "min_self_clearance_m");
  check_option(min_balance_margin < 1.0 && std::isfinite(min_balance_margin), "min_balance_margin",
               "a number below 1");
  positive(max_step_m, "max_step_m");
  positive(max_step_rad, "max_step_rad");
  positive(max_samples_per_step, "max_samples_per_step");
  positive(threads, "threads");
  positive(clearance_resolution_m, "clearance_resolution_m");
  positive(balance_resolution_m, "balance_resolution_m");
  not_negative(joint_tolerance_rad, "joint_tolerance_rad");
  not_negative(velocity_tolerance, "velocity_tolerance");
  not_negative(quaternion_tolerance, "quaternion_tolerance");
}

std::string violation_text(const Violation& v) {
  const std::string name = v.constraint + (v.what.empty() ? "" : " (" + v.what + ")");
  if (!v.judged) return v.constraint + " is not judged: " + v.why_not;
  const std::string unit = v.unit == "1" ? "" : " " + v.unit;
  const std::string worst =
      std::isfinite(v.worst) ? number(v.worst) + unit : std::string(kBeyondMeasure);
  return name + " is " + worst + ", limit " + number(v.limit) + unit;
}

const Violation& CheckReport::worst() const {
  const std::vector<const Violation*> all = violated();
  if (!all.empty()) return *all.front();
  // Without a violation it is one of these that was required and not judged.
  for (const Violation& v : violations)
    if (!feasible && !v.judged &&
        (v.constraint == "obstacle_distance" || v.constraint == "static_balance"))
      return v;
  return violations.front();
}

std::vector<const Violation*> CheckReport::violated() const {
  std::vector<const Violation*> all;
  for (const Violation& v : violations)
    if (v.violated) all.push_back(&v);
  std::stable_sort(all.begin(), all.end(),
                   [](const Violation* a, const Violation* b) { return excess(*a) > excess(*b); });
  return all;
}

const Violation& CheckReport::constraint(const std::string& name) const {
  for (const Violation& violation : violations)
    if (violation.constraint == name) return violation;
  throw Error("no constraint \"" + name + "\" in the report", "one that judge.h lists");
}

}  // namespace locograph
