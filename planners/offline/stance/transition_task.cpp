#include <locograph/planners/offline/stance/transition_task.h>

#include <algorithm>
#include <cstring>

namespace locograph {
namespace {

/// Of polygons about places that balls have rolled to; how often these are looked for or torques
/// eased: either may undo the other.
constexpr double kRolledResolution_m = 2e-3;
constexpr int kMostRounds = 4;

bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  if (a.size() != b.size()) return false;
  const std::size_t bytes = static_cast<std::size_t>(a.size()) * sizeof(double);
  return bytes == 0 || std::memcmp(a.data(), b.data(), bytes) == 0;
}

}  // namespace

bool same_task(const TransitionTask& a, const TransitionTask& b) {
  return a.larger == b.larger && a.smaller == b.smaller && a.seed == b.seed &&
         a.options == b.options && same_bits(a.start, b.start) &&
         same_bits(a.preferred, b.preferred) && same_bits(a.before, b.before) &&
         (a.before.size() == 0 || a.opens == b.opens);
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
  if (task.margin.self_distance_m > 0.0 && preferred_.size() > 0) {
    solver_.leave_as_near(preferred_, task.margin.self_distance_m);
  }
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
  HeldBalls balls;
  if (task.before.size() > 0) {
    state_.update(task.before.data());
    balls = held_balls(state_, task.closed, [&task](const Contact& contact) {
      return task.opens ||
             std::ranges::find(task.held, contact.name(), &Contact::name) != task.held.end();
    });
    problem.rolled_from = balls;
  }
  TransitionResult result = solver_.solve(problem, task.options);
  std::optional<TorqueProgramme> torques;
  for (int round = 0; result.success(); ++round) {
    state_.update(result.configuration.data());
    const bool balanced = is_balanced(task, !balls.empty());
    if (balanced && (problem.torques != nullptr || !is_too_heavy(task, torques))) break;
    if (round == kMostRounds) {
      result.status = PlannerStatus::kNotFound;
      result.failure = TransitionFailure::kBalance;
      result.reason = "the centre of mass outside what the contacts balance";
      break;
    }
    if (balanced) {
      problem.torques = &*torques;
    } else {
      balance_here(task, !balls.empty(), problem);
    }
    problem.start = result.configuration;
    result = solver_.solve(problem, task.options);
  }
  return result;
}

/// Balls where they have rolled to, and the larger stance where it has to bear as well.
bool TaskSolver::is_balanced(const TransitionTask& task, bool rolls) const {
  const double mass_kg = state_.robot().total_mass();
  const Eigen::Vector2d com = state_.center_of_mass().head<2>();
  const auto holds = [&](std::span<const BearingContact> contacts) {
    return contacts.empty() || balances(mass_kg, rolled_to(state_, contacts), kRegionMargin, com);
  };
  return (!rolls || holds(task.bearing)) && holds(task.all_bearing);
}

/// The polygons are those of the touch-down places, worked out once for all: where they will not
/// do, those of the places rolled to take their place.
void TaskSolver::balance_here(const TransitionTask& task, bool rolls, TransitionProblem& problem) {
  const auto region = [&](const Footing& footing, std::span<const BearingContact> contacts) {
    return rolls ? balance_region(state_.robot().total_mass(), rolled_to(state_, contacts),
                                  kRegionMargin, kRolledResolution_m)
                 : regions_.of(footing, contacts);
  };
  region_ = region(task.smaller, task.bearing);
  if (!task.all_bearing.empty() && !region_.empty()) {
    BalanceRegion of_both = region(task.larger, task.all_bearing);
    if (!of_both.empty()) {
      of_both.sides.insert(of_both.sides.end(), region_.sides.begin(), region_.sides.end());
      of_both.width_m = std::min(of_both.width_m, region_.width_m);
    }
    region_ = std::move(of_both);
  }
  problem.balance = &region_;
}

bool TaskSolver::is_too_heavy(const TransitionTask& task,
                              std::optional<TorqueProgramme>& torques) const {
  if (!task_.check.enforce_torque_limits) return false;
  torques.emplace(state_.robot(), task.bearing, task_.check.effort_scale * task_.margin.torque,
                  kRegionMargin);
  Eigen::VectorXd gradient;
  return torques->solve(state_, gradient) > 1.0 - task.options.torque_margin;
}

}  // namespace locograph
