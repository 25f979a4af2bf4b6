#include "judged_windows.h"

#include <locograph/check/motion_curve.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/plan/slope_limits.h>

#include <algorithm>
#include <utility>

namespace locograph {
namespace {

/// From the executed configuration to the last one of the window, with the slopes that `refine`
/// would give them. It passes the last one as it moved before: what comes after it will change.
Motion window_of(const Graph& graph, const Plan& plan, const CycleReport& cycle) {
  const Robot& robot = *plan.robot->robot;
  const int last = cycle.executed + cycle.window;
  Motion whole = motion_of(graph, plan);
  const int planned = static_cast<int>(whole.configurations.size());
  const auto next = static_cast<std::size_t>(last) + 1;
  if (next < whole.configurations.size()) {
    const Eigen::VectorXd &before = whole.configurations[next - 2],
                          &at = whole.configurations[next - 1];
    Eigen::VectorXd moved(robot.tangent_size());
    robot.difference(before.data(), at.data(), moved.data());
    robot.integrate(at.data(), moved.data(), whole.configurations[next].data());
    whole.time_s[next] = 2.0 * whole.time_s[next - 1] - whole.time_s[next - 2];
    whole.slopes[next - 1] = {};
  }
  for (int i = std::max(1, cycle.executed); i <= last && i + 1 < planned; ++i) {
    Eigen::VectorXd& slope = whole.slopes[static_cast<std::size_t>(i)];
    if (slope.size() == 0) slope = careful_slope(robot, whole, i);
  }
  return part_of(MotionCurve(robot, whole), cycle.executed, last);
}

std::string first_refusal(const CheckReport& report) {
  for (const Violation& v : report.violations) {
    if (v.violated) return violation_text(v);
  }
  return violation_text(report.worst());
}

}  // namespace

JudgedWindows::JudgedWindows(const Graph& graph, const Judge& judge, CheckOptions options,
                             int every)
    : graph_(graph), judge_(judge), options_(std::move(options)), every_(every) {
  options_.starts_at_rest = options_.ends_at_rest = false;
}

void JudgedWindows::look(const CycleReport& cycle) {
  if (cycles_++ % every_ != 0) return;
  const CheckReport judged = judge_.check(window_of(graph_, plan_of(graph_), cycle), options_);
  ++counts_.windows;
  counts_.called_feasible += cycle.success() ? 1 : 0;
  counts_.judged_feasible += judged.feasible ? 1 : 0;
  counts_.agreed_feasible += cycle.success() && judged.feasible ? 1 : 0;
  if (!cycle.success() || judged.feasible) return;
  ++counts_.wrongly_feasible;
  if (counts_.refused.empty()) counts_.refused = first_refusal(judged);
}

}  // namespace locograph
