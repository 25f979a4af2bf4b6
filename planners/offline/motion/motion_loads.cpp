#include <locograph/check/motion_curve.h>
#include <locograph/planners/balance/least_wrenches.h>
#include <locograph/planners/offline/motion/motion_loads.h>
#include <locograph/robots/statics.h>

#include <algorithm>
#include <cmath>

namespace locograph {

MotionLoads::MotionLoads(const Robot& robot)
    : robot_(robot),
      state_(robot),
      dynamics_(robot),
      still_(Eigen::VectorXd::Zero(robot.tangent_size())),
      asked_(robot.tangent_size()) {}

std::optional<SegmentLoads> MotionLoads::along(std::span<const BearingContact> contacts,
                                               double effort_scale, const Motion& motion) {
  LeastWrenches least(robot_, contacts, effort_scale);
  const MotionCurve curve(robot_, motion);
  const int last = static_cast<int>(motion.configurations.size()) - 1;
  SegmentLoads loads;
  for (int i = 0; i <= last; ++i) {
    const bool moves = i > 0 && i < last;
    const CurvePoint point = moves ? curve.through_vertex(i) : CurvePoint{{}, still_, still_};
    state_.update(motion.configurations[static_cast<std::size_t>(i)].data());
    dynamics_.inverse_dynamics(state_, point.velocity, point.acceleration, {}, asked_);
    if (!least.solve(state_, asked_)) return std::nullopt;
    loads.wrenches.push_back(least.wrenches());
    if (i == 0) continue;
    const auto k = static_cast<std::size_t>(i);
    const double h = motion.time_s[k] - motion.time_s[k - 1];
    loads.rates.push_back(change(loads.wrenches[k - 1], loads.wrenches[k]) / h);
    loads.fastest = std::max(loads.fastest, loads.rates.back());
  }
  return loads;
}

double MotionLoads::change(const StanceWrenches& from, const StanceWrenches& to) const {
  const double weight_N = robot_.total_mass() * standard_gravity().norm();
  double most = 0.0;
  for (std::size_t c = 0; c < from.size(); ++c) {
    most = std::max(most, (to[c].head<3>() - from[c].head<3>()).norm() / weight_N);
  }
  return most;
}

double MotionLoads::append(const Dwell& dwell, Motion& motion) const {
  constexpr double kStep_s = 0.1;
  const double duration_s = std::max(dwell.least_s, change(dwell.from, dwell.to) / kFastestLoad);
  const int steps = std::max(1, static_cast<int>(std::ceil(duration_s / kStep_s - 1e-9)));
  for (int i = 0; i < steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    motion.configurations.push_back(dwell.configuration);
    motion.slopes.push_back(still_);
    motion.stance_from.push_back(dwell.stance);
    motion.time_s.push_back(dwell.begin_s + share * duration_s);
    if (dwell.from.empty()) continue;
    StanceWrenches& now = motion.wrenches.emplace_back(dwell.from);
    for (std::size_t c = 0; c < now.size(); ++c) now[c] += share * (dwell.to[c] - dwell.from[c]);
  }
  return duration_s;
}

}  // namespace locograph
