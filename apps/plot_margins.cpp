#include <locograph/apps/plot_margins.h>
#include <locograph/check/judge.h>
#include <locograph/check/loaded_contact.h>
#include <locograph/check/motion_curve.h>
#include <locograph/robots/dynamics.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

constexpr std::size_t kMostLooks = 200;
constexpr double kFurthest_mm = 50.0;  // that distances of a posture are looked for

const Stance& stance_at(const Motion& motion, std::size_t vertex) {
  return motion.stances[static_cast<std::size_t>(motion.stance_from[vertex])];
}

/// A series of small values is what comes near a limit.
Series least_first(const std::string& name, std::vector<double> values) {
  Series series{name, std::move(values)};
  series.peak = -*std::ranges::min_element(series.values);
  return series;
}

}  // namespace

std::vector<Eigen::VectorXd> torques_along(const Robot& robot, const Motion& motion) {
  std::vector<Eigen::VectorXd> all;
  const bool states_none = std::ranges::all_of(
      motion.wrenches, [](const StanceWrenches& wrenches) { return wrenches.empty(); });
  if (states_none) return all;
  RobotState state(robot);
  RobotDynamics dynamics(robot);
  const MotionCurve curve(robot, motion);
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(robot.tangent_size());
  Eigen::VectorXd torques(robot.tangent_size()), borne(robot.tangent_size());
  const std::size_t last = motion.configurations.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    CurvePoint point{{}, still, still};
    if (i > 0 && i < last && !motion.stances_only) {
      point = curve.through_vertex(static_cast<int>(i));
    }
    state.update(motion.configurations[i].data());
    dynamics.inverse_dynamics(state, point.velocity, point.acceleration, {}, torques);
    borne.setZero();
    for (std::size_t c = 0; c < motion.wrenches[i].size(); ++c) {
      const LoadedContact contact = loaded_contact(state, stance_at(motion, i).contacts[c]);
      add_wrench_torques(state,
                         contact.applied(state, Eigen::Vector3d::Zero(), motion.wrenches[i][c]),
                         1.0, borne);
    }
    all.emplace_back((torques - borne).tail(robot.active_joint_count()));
  }
  return all;
}

PlanMargins margins_along(const Motion& motion, const Judging& judging) {
  const Judge judge(judging.robot, judging.world);
  PlanMargins margins;
  std::vector<double> world, self, balance;
  const std::size_t last = motion.configurations.size() - 1;
  const std::size_t looks = std::min(last, kMostLooks);
  for (std::size_t look = 0; look <= looks; ++look) {
    const std::size_t i = look * last / looks;
    const CheckReport report =
        judge.check(motion.configurations[i], stance_at(motion, i), judging.options);
    margins.time_s.push_back(motion.time_s[i]);
    if (report.min_clearance_m) world.push_back(1e3 * *report.min_clearance_m);
    if (report.min_self_clearance_m) self.push_back(1e3 * *report.min_self_clearance_m);
    if (report.min_balance_margin) balance.push_back(*report.min_balance_margin);
  }
  const auto add = [&](const std::string& name, std::vector<double> values, double most,
                       std::vector<Series>& to) {
    if (values.size() != margins.time_s.size()) return;
    for (double& value : values) value = std::min(value, most);
    to.push_back(least_first(name, std::move(values)));
  };
  add("of links to obstacles", std::move(world), kFurthest_mm, margins.distances);
  add("of links to each other", std::move(self), kFurthest_mm, margins.distances);
  add("static balance", std::move(balance), 1.0, margins.balance);
  return margins;
}

}  // namespace locograph
