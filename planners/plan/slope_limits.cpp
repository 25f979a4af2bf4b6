#include <locograph/check/motion_curve.h>
#include <locograph/planners/plan/slope_limits.h>

#include <algorithm>

namespace locograph {
namespace {

Motion without_slopes(const Motion& motion, const PlanRange& range) {
  Motion part;
  part.stances = motion.stances;
  part.stances_only = motion.stances_only;
  for (int i = range.first; i <= range.last; ++i) {
    const auto at = static_cast<std::size_t>(i);
    part.time_s.push_back(motion.time_s[at]);
    part.configurations.push_back(motion.configurations[at]);
    part.stance_from.push_back(motion.stance_from[at]);
  }
  return part;
}

}  // namespace

Eigen::VectorXd careful_slope(const Robot& robot, const Motion& motion, int vertex) {
  const auto first = static_cast<std::size_t>(vertex) - 1;
  Motion around;
  for (std::size_t i = first; i < first + 3; ++i) {
    around.time_s.push_back(motion.time_s[i]);
    around.configurations.push_back(motion.configurations[i]);
  }
  const double before_s = around.time_s[1] - around.time_s[0];
  const double after_s = around.time_s[2] - around.time_s[1];
  const auto rates = [&](std::size_t i, double step_s) {
    Eigen::VectorXd moved(robot.tangent_size());
    robot.difference(around.configurations[i].data(), around.configurations[i + 1].data(),
                     moved.data());
    return Eigen::VectorXd(moved / step_s);
  };
  const Eigen::VectorXd before = rates(0, before_s), after = rates(1, after_s);
  const double slower = std::min(before.norm(), after.norm());
  Eigen::VectorXd slope = MotionCurve(robot, around).slope(1);
  if (slower > 0.0) slope *= 1.0 - 0.5 * (after.normalized() - before.normalized()).norm();
  if (slope.norm() > 3.0 * slower) slope *= 3.0 * slower / slope.norm();
  keep_within_limits(robot, around.configurations[1], std::max(before_s, after_s), slope);
  return slope;
}

Motion motion_of_slopes(const Graph& graph, const Plan& plan) {
  Motion is = motion_of(graph, plan);
  Motion planned = is;
  planned.configurations = tracked_configurations(graph, plan);
  const auto unknown = [](const Eigen::VectorXd& q) { return q.size() == 0; };
  if (std::ranges::any_of(planned.configurations, unknown)) return is;
  const auto off = [&](const Motion& motion) {
    Motion by_rule = motion;
    by_rule.slopes.clear();
    const MotionCurve curve(*plan.robot->robot, by_rule);
    double sum = 0.0;
    for (std::size_t i = 0; i < motion.slopes.size(); ++i) {
      const Eigen::VectorXd& slope = motion.slopes[i];
      if (slope.size() > 0) sum += (slope - curve.slope(static_cast<int>(i))).squaredNorm();
    }
    return sum;
  };
  return off(planned) < off(is) ? planned : is;
}

bool moved_around(const Motion& before, const Plan& plan, const Graph& graph, int i) {
  constexpr double kMoved = 1e-9;
  const int end = static_cast<int>(plan.slots.size()) - 1;
  for (int k = std::max(i - 1, 0); k <= std::min(i + 1, end); ++k) {
    const auto at = static_cast<std::size_t>(k);
    const int slot = plan.slots[at];
    const Eigen::Map<const Eigen::VectorXd> is(graph.state(slot), graph.state_size(slot));
    if ((is - before.configurations[at]).lpNorm<Eigen::Infinity>() > kMoved) return true;
  }
  return false;
}

void carry_slopes(const Motion& before, const Plan& plan, Graph& graph) {
  carry_slopes(before, plan, graph, {0, static_cast<int>(plan.slots.size()) - 1});
}

void carry_slopes(const Motion& before, const Plan& plan, Graph& graph, const PlanRange& range,
                  Rests rests) {
  const Robot& robot = *plan.robot->robot;
  const int end = static_cast<int>(plan.slots.size()) - 1;
  const PlanRange around = {std::max(range.first - 1, 0), std::min(range.last + 1, end)};
  const Motion rule_before = without_slopes(before, around);
  Motion rule_after = motion_of(graph, plan, around.first, around.last);
  rule_after.slopes.clear();
  const MotionCurve was(robot, rule_before), is(robot, rule_after);
  for (int i = around.first + 1; i < around.last; ++i) {
    const int vertex = i - around.first;
    const auto at = static_cast<std::size_t>(vertex);
    Eigen::VectorXd& slope =
        graph.vertex(VertexId<VertexConfiguration>{plan.slots[static_cast<std::size_t>(i)]}).slopes;
    if (slope.size() == 0 || (rests == Rests::kStay && slope.isZero())) continue;
    if (!moved_around(before, plan, graph, i)) continue;
    const std::vector<double>& time_s = rule_before.time_s;
    const double step_s = std::max(time_s[at] - time_s[at - 1], time_s[at + 1] - time_s[at]);
    if (!(step_s > 0.0)) continue;
    slope += is.slope(vertex) - was.slope(vertex);
    keep_within_limits(robot, rule_after.configurations[at], step_s, slope);
  }
}

void keep_within_limits(const Robot& robot, const Eigen::VectorXd& configuration, double step_s,
                        Eigen::VectorXd& slope) {
  for (int j = 0; j < robot.active_joint_count(); ++j) {
    const Joint& joint = robot.active_joint(j);
    const double position = configuration[robot.base_configuration_size() + j];
    double& of = slope[robot.base_tangent_size() + j];
    const double room = std::max(0.0, std::min(position - joint.lower, joint.upper - position));
    of = std::clamp(of, -3.0 * room / step_s, 3.0 * room / step_s);
  }
}

}  // namespace locograph
