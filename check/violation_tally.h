#pragma once
/// Collects the values of one constraint along a motion: the worst, and where the limit is broken.
///
///     locograph::ViolationTally tally("wheel_tilt", "rad", 0.09, locograph::Worse::kHigher, 50);
///     tally.add(tilt, vertex, time_s, point, [&] { return wheel_name; });
///     report.violations.push_back(tally.result("there are no wheels"));
///
/// A value that is not a number is a violation. The text is made only for a new worst value.

#include <locograph/check/check_report.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace locograph {

enum class Worse { kHigher, kLower };

class ViolationTally {
 public:
  /// slack: how far beyond the limit is still counted as rounding.
  ViolationTally(std::string constraint, std::string unit, double limit, Worse worse,
                 std::size_t vertices, double slack = 0.0)
      : sign_(worse == Worse::kHigher ? 1.0 : -1.0), slack_(slack), violated_at_(vertices, false) {
    result_.constraint = std::move(constraint);
    result_.unit = std::move(unit);
    result_.limit = limit;
  }

  /// True if the value is the worst so far. Of values equal up to rounding the first one counts.
  template <class Text>
  bool add(double value, int vertex, double time_s, const Eigen::Vector3d& point,
           const Text& text) {
    if (!(sign_ * (value - result_.limit) <= slack_)) mark(vertex);
    constexpr double kRounding = 1e-9;
    if (!empty_ && !std::isnan(value) && sign_ * (value - result_.worst) <= kRounding) return false;
    empty_ = false;
    result_.worst = value;
    result_.at_vertex = vertex;
    result_.time_s = time_s;
    result_.at_point = point;
    result_.what = text();
    return true;
  }

  void set_unit(const std::string& unit) { result_.unit = unit; }
  bool empty() const { return empty_; }
  bool violated_at(int vertex) const { return violated_at_[std::size_t(vertex)]; }
  double worst() const { return result_.worst; }
  double limit() const { return result_.limit; }
  const Violation& result() const { return result_; }
  /// Not judged, because …, if there was no value.
  Violation result(const std::string& why_not) const {
    Violation result = result_;
    result.judged = !empty_;
    if (empty_) result.why_not = why_not;
    return result;
  }

 private:
  void mark(int vertex) {
    result_.violated = true;
    if (violated_at_[std::size_t(vertex)]) return;
    violated_at_[std::size_t(vertex)] = true;
    ++result_.count;
  }

  double sign_, slack_;
  bool empty_ = true;
  std::vector<bool> violated_at_;
  Violation result_;
};

}  // namespace locograph
