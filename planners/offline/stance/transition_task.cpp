#include <locograph/planners/offline/stance/transition_task.h>

#include <algorithm>
#include <cstring>

namespace locograph {
namespace {

bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  if (a.size() != b.size()) return false;
  const std::size_t bytes = static_cast<std::size_t>(a.size()) * sizeof(double);
  return bytes == 0 || std::memcmp(a.data(), b.data(), bytes) == 0;
}

}  // namespace

bool same_task(const TransitionTask& a, const TransitionTask& b) {
  return a.larger == b.larger && a.smaller == b.smaller && a.seed == b.seed &&
         a.options == b.options && same_bits(a.start, b.start) &&
         same_bits(a.preferred, b.preferred);
}

const BalanceRegion& BalanceRegions::of(const Footing& footing,
                                        std::span<const BearingContact> contacts) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = regions_.find(footing);
    if (found != regions_.end()) return found->second;
  }
  // Two threads may both get here, to the same region.
  BalanceRegion region;
  if (!contacts.empty()) region = balance_region(mass_kg_, contacts, kRegionMargin);
  const std::lock_guard<std::mutex> lock(mutex_);
  return regions_.emplace(footing, std::move(region)).first->second;
}

TaskSolver::TaskSolver(const Task& task, BalanceRegions& regions)
    : task_(task),
      regions_(regions),
      solver_(task.robot, task.world->world()),
      state_(*task.robot->robot),
      preferred_(task.start_configuration) {
  // A posture that tends to a limit would always be pulled out of the margin.
  const double margin = task.margin.joint_rad;
  const Robot& robot = state_.robot();
  for (int i = 0; margin > 0.0 && preferred_.size() > 0 && i < robot.active_joint_count(); ++i) {
    const Joint& joint = robot.active_joint(i);
    double& x = preferred_[robot.base_configuration_size() + i];
    if (joint.upper - joint.lower <= 2.0 * margin) continue;
    x = std::clamp(x, joint.lower + margin, joint.upper - margin);
  }
}

TransitionResult TaskSolver::solve(const TransitionTask& task) {
  TransitionProblem problem;
  problem.closed = task.closed;
  problem.held = task.held;
  problem.balance = &regions_.of(task.smaller, task.bearing);
  problem.start = task.start;
  problem.preferred = task.preferred.size() > 0 ? task.preferred : preferred_;
  problem.seed = task.seed;
  TransitionResult result = solver_.solve(problem, task.options);
  BalanceRegion of_both;
  if (result.success() && !task.all_bearing.empty()) {
    balance_larger(task, problem, of_both, result);
  }
  if (result.success() && task_.check.enforce_torque_limits) ease_torques(task, problem, result);
  return result;
}

void TaskSolver::balance_larger(const TransitionTask& task, TransitionProblem& problem,
                                BalanceRegion& of_both, TransitionResult& result) {
  state_.update(result.configuration.data());
  const Eigen::Vector2d centre = state_.center_of_mass().head<2>();
  if (balances(state_.robot().total_mass(), task.all_bearing, kRegionMargin, centre)) return;
  of_both = regions_.of(task.larger, task.all_bearing);
  if (!of_both.empty()) {
    const BalanceRegion& smaller = *problem.balance;
    of_both.sides.insert(of_both.sides.end(), smaller.sides.begin(), smaller.sides.end());
    of_both.width_m = std::min(of_both.width_m, smaller.width_m);
  }
  problem.balance = &of_both;
  problem.start = result.configuration;
  result = solver_.solve(problem, task.options);
}

void TaskSolver::ease_torques(const TransitionTask& task, TransitionProblem& problem,
                              TransitionResult& result) {
  TorqueProgramme torques(state_.robot(), task.bearing,
                          task_.check.effort_scale * task_.margin.torque, kRegionMargin);
  state_.update(result.configuration.data());
  Eigen::VectorXd gradient;
  if (torques.solve(state_, gradient) <= 1.0 - task.options.torque_margin) return;
  problem.torques = &torques;
  problem.start = result.configuration;
  result = solver_.solve(problem, task.options);
}

}  // namespace locograph
